// Files that are either as they were or as they shall be, whatever happens meanwhile.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace limpid {

// Puts the bytes on the disk beside `file` and gives them its name then. Errors: FileError; the
// file is then as it was. Pipes and devices are written into instead.
void write_atomically(const std::filesystem::path& file, std::span<const unsigned char> bytes);

// The same for text and a folder that may not be there yet, for what is not worth losing work over:
// returns what went wrong, empty if nothing did.
std::string try_write_atomically(const std::filesystem::path& file, std::string_view text);

}  // namespace limpid
