// The folder in which a command leaves its results.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace limpid {

// A command writes over files of these names in a folder that it claimed for them, and over no
// others.
struct OutFolder {
  std::filesystem::path path;
  std::string made_by;             // "limpid experiment": the results are that command's
  std::vector<std::string> names;  // of its files, without their extensions
  bool force = false;              // the command may replace any file of these names
};

// The note in such a folder: the command that claimed it, and the names, a line each.
inline constexpr const char* kOutNote = "limpid.txt";

// Makes the folder before any work, so that no result is lost to a place that cannot be written or
// is full. Errors: UsageError.
void prepare_out(const std::filesystem::path& dir);

// Refuses a folder that has a file of one of the names. Errors: UsageError.
void refuse_foreign(const OutFolder& folder);

// Makes the folder and leaves the note there. Refuses files of names that no note of this command
// has. Errors: UsageError.
void claim_out(const OutFolder& folder);

void add_force(CLI::App& command, bool& force);

}  // namespace limpid
