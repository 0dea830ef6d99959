// Files in xacro are expanded by the program `xacro`, which runs code that the file contains: only
// somebody who named the file himself can want that.
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>

#include "devices/files/file_error.h"

namespace limpid {

enum class Xacro : std::uint8_t { refuse, expand };

// A file that would have to be expanded, and nobody has said that it may be.
struct XacroToExpand : FileError {
  explicit XacroToExpand(std::filesystem::path of)
      : FileError(of.string() +
                  ": is a xacro file: expanding it runs program xacro, which can run code in the "
                  "file. Only what is named on the command line is expanded without a question; "
                  "expand it first (xacro FILE > arm.urdf), or call limpid sweep with "
                  "--allow-xacro"),
        file(std::move(of)) {}

  std::filesystem::path file;
};

}  // namespace limpid
