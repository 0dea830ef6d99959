// Whole text files into memory, and what their lines need.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace limpid {

// The text of a regular file, without a UTF-8 byte order mark. Errors: FileError for a file that
// is missing, no regular file, unreadable or longer than `limit` bytes.
std::string read_text(const std::filesystem::path& file, std::size_t limit);

// Without the blanks, tabs and carriage returns at its ends.
inline constexpr std::string_view kBlanks = " \t\r";
std::string_view trimmed(std::string_view text);

}  // namespace limpid
