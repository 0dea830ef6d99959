// Files that are either as they were or as they shall be, whatever happens meanwhile.
#pragma once

#include <filesystem>
#include <span>

namespace limpid {

// Puts the bytes on the disk beside `file` and gives them its name then. Errors: FileError; the
// file is then as it was.
void write_atomically(const std::filesystem::path& file, std::span<const unsigned char> bytes);

}  // namespace limpid
