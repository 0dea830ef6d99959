// Folders, files and refusals for the tests of files.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "devices/files/text_file.h"
#include "tests/support/temp_dir.h"

namespace limpid::test {

inline void write_file(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

inline std::string file_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Runs `work` and returns the message of the Error it throws, "" if it throws none.
template <class Error = FileError, class Work>
std::string refusal(Work work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

inline std::filesystem::path assets() { return LIMPID_ASSETS_DIR; }

// Folder of recordings outside the repository; empty if this computer has none.
inline std::filesystem::path shared_hands() {
  const char* named = getenv("LIMPID_SHARED");
  const std::filesystem::path folder =
      std::filesystem::path(named ? named : LIMPID_SHARED_DIR) / "data" / "hand";
  return std::filesystem::is_directory(folder) ? folder : std::filesystem::path{};
}

}  // namespace limpid::test
