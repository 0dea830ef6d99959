// Where files that take long to write go: OUT.part while they grow, OUT once they are whole.
#pragma once

#include <filesystem>

namespace limpid {

// OUT -> OUT.part
std::filesystem::path part_of(const std::filesystem::path& out);

// Whether there can be a new file in the folder of `out`, before it is made. Errors: FileError.
void check_folder(const std::filesystem::path& out);
// The same for `out` itself, which must not be a folder, nor, without `force`, a file.
void check_place(const std::filesystem::path& out, bool force);

// Brings a finished file to the disk and gives it its name. Errors: FileError.
void publish(const std::filesystem::path& finished, const std::filesystem::path& out, bool force);

}  // namespace limpid
