#include "devices/files/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace limpid {

std::string read_text(const std::filesystem::path& file, std::size_t limit) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) {
    const bool absent = status.type() == std::filesystem::file_type::not_found;
    throw FileError(
        fmt::format("{}: {}", file.string(), absent ? "no such file" : error.message()));
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw FileError(fmt::format("{}: not a file that can be read", file.string()));
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) throw FileError(fmt::format("{}: {}", file.string(), std::strerror(errno)));

  const auto size = std::filesystem::file_size(file);
  if (size > limit) {
    throw FileError(
        fmt::format("{}: has {} bytes; allowed: at most {}", file.string(), size, limit));
  }
  std::string text(size, '\0');
  in.read(text.data(), static_cast<std::streamsize>(size));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

}  // namespace limpid
