// Whole text files into memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace limpid {

// The text of a regular file, without a UTF-8 byte order mark. Errors: FileError for a file that
// is missing, no regular file, unreadable or longer than `limit` bytes.
std::string read_text(const std::filesystem::path& file, std::size_t limit);

}  // namespace limpid
