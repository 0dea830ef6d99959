// Parameters from TOML files and from the command line.
//
//     observer.alpha = 0.05      # dotted keys
//     [coupling]                 # or tables
//     kind = "proposed"
//     eta = 0.6
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/tick/parameters.h"

namespace limpid {

// Sets what the file says and leaves the rest. Errors: FileError "FILE:LINE: KEY: ..."; `p` is then
// unchanged. They are for text that is not TOML, for an unknown key (naming the nearest known one),
// and for a value that is not allowed.
void apply_config(Parameters& p, const std::filesystem::path& file);
void apply_config_text(Parameters& p, std::string_view text, const std::string& where);

// True of a key that files of Limpid 0.2 may have, and that sets nothing any more: it chose among
// constants of the predictive law's former filter. The functions for text pass over it.
bool is_retired(std::string_view key);
// True of text that has such a key. Errors: FileError for text that is not TOML.
bool has_retired(std::string_view text, const std::string& where);

// A key of a table that was not applied, and why, in the words of apply_config(). The key is empty
// if the table is no table.
struct UntakenKey {
  std::string key, why;
};
// Applies one table of a text key by key, leaving out what cannot be applied. Errors: FileError for
// text that is not TOML.
std::vector<UntakenKey> take_config_table(Parameters& p, const std::string& text,
                                          const std::string& table, const std::string& where);

// Returns the key of a "key=value", without the spaces around it.
std::string key_of_setting(std::string_view setting);
// Applies one "key=value" of `--set`; bare words are text. Errors: ParameterError.
void apply_setting(Parameters& p, std::string_view setting);

// TOML that gives these parameters again to the last bit, without those left to the arm.
std::string config_text(const Parameters& p);

}  // namespace limpid
