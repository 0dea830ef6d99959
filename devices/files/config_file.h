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

// Sets what the file says and leaves the rest. Errors: FileError "FILE:LINE: KEY: ..." for text
// that is not TOML, a key that does not exist (naming the nearest one that does), a value that is
// not allowed; `p` is then unchanged.
void apply_config(Parameters& p, const std::filesystem::path& file);
void apply_config_text(Parameters& p, std::string_view text, const std::string& where);

// The same of one table of a text, key by key: what cannot be taken is left as it is, and said in
// the words of apply_config. Its key is empty where the table is something else. Errors: FileError
// for text that is not TOML.
struct UntakenKey {
  std::string key, why;
};
std::vector<UntakenKey> take_config_table(Parameters& p, const std::string& text,
                                          const std::string& table, const std::string& where);

// One "key=value" of `--set`; bare words stand for text. Errors: ParameterError.
void apply_setting(Parameters& p, std::string_view setting);

// TOML that gives these parameters again to the last bit; what is left to the arm is left out.
std::string config_text(const Parameters& p);

}  // namespace limpid
