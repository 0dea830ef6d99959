// URDF files as they lie on the disk: plain ones, and xacro's, which have to be expanded.
#pragma once

#include <filesystem>
#include <string>

#include "devices/files/arm/xacro_consent.h"

namespace limpid {

// The URDF text of a file. One that is written in xacro (FILE.xacro, or macros inside) goes through
// the program `xacro`, if that is installed and `xacro` says that it may; any encoding becomes
// UTF-8. Errors: XacroToExpand where it may not; FileError for files that cannot be read or are
// longer than 16 MiB; for xacro without the program, saying how to expand it, or with what the
// program complains of.
std::string urdf_text(const std::filesystem::path& file, Xacro xacro);

}  // namespace limpid
