#include "render/model/companions.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <stdexcept>

namespace limpid {

namespace fs = std::filesystem;

std::string one_line(std::string text) {
  constexpr std::size_t kLongest = 300;
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  return text;
}

void refuse(const std::string& name, const std::string& why) {
  throw std::runtime_error(name + ": " + one_line(why));
}

std::vector<unsigned char> read_bytes(const fs::path& path, std::size_t most) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) refuse(path.string(), "cannot be read");
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file.tellg();
  if (size < 0) refuse(path.string(), "cannot be read");
  if (static_cast<std::size_t>(size) > most)
    refuse(path.string(), "makes the model larger than the limit of " +
                              std::to_string(kLargestModelFiles >> 20) + " MiB");
  std::vector<unsigned char> bytes(static_cast<std::size_t>(size));
  file.seekg(0).read(reinterpret_cast<char*>(bytes.data()), size);
  if (!file) refuse(path.string(), "cannot be read");
  return bytes;
}

std::string decoded_uri(const std::string& uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned char code = 0;
    const char* const digits = uri.data() + i + 1;
    if (uri[i] == '%' && i + 2 < uri.size() &&
        std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
      out += static_cast<char>(code);
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

fs::path Companions::resolve(const std::string& uri) const {
  const std::string what = "refers to \"" + uri + "\"";
  const fs::path relative(uri);
  const bool odd = uri.empty() || relative.is_absolute() || uri.find(':') != uri.npos ||
                   uri.find('\\') != uri.npos || std::any_of(uri.begin(), uri.end(), [](char c) {
                     return static_cast<unsigned char>(c) < 0x20;
                   });
  if (odd || std::find(relative.begin(), relative.end(), "..") != relative.end())
    refuse(name_, what + "; allowed: files in its own folder");
  std::error_code error;
  const auto home = fs::canonical(folder_, error);
  const auto file = fs::weakly_canonical(home / relative, error);
  const auto inside = std::mismatch(home.begin(), home.end(), file.begin(), file.end());
  if (error || inside.first != home.end())
    refuse(name_, what + ", which is outside of its own folder");
  return file;
}

std::optional<std::vector<unsigned char>> Companions::read(const std::string& uri) {
  fs::path file = resolve(uri);
  std::error_code error;
  if (!fs::exists(file, error)) file = resolve(decoded_uri(uri));
  if (!fs::exists(file, error)) return std::nullopt;
  auto bytes = read_bytes(file, left_);
  left_ -= bytes.size();
  return bytes;
}

}  // namespace limpid
