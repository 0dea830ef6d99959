#include "render/model/assimp/assimp_guard.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string_view>

namespace limpid {
namespace {

std::string_view text_of(std::span<const unsigned char> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The number that `text` begins with, or none.
std::size_t number_in(std::string_view text) {
  while (!text.empty() && (text[0] == ' ' || text[0] == '\t' || text[0] == '"' || text[0] == '\''))
    text.remove_prefix(1);
  std::size_t number = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
  return end.ec == std::errc::result_out_of_range ? ~std::size_t{0} : number;
}

// Behind each `word` in the text there is a number of things, of which each takes a byte at least.
void guard(std::string_view text, std::string_view word, std::size_t size) {
  for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    std::string_view rest = text.substr(at + word.size());
    if (word == "element ") {  // NAME NUMBER
      const auto end = rest.find_first_of(" \t\n");
      rest = end == rest.npos ? "" : rest.substr(end);
    }
    if (number_in(rest) > size) throw std::runtime_error("says that it has more than fits into it");
  }
}

}  // namespace

void guard_counts(std::span<const unsigned char> bytes, const std::string& kind) {
  const std::string_view text = text_of(bytes);
  if (kind == "ply") {
    const auto end = text.find("end_header");
    if (end == text.npos) throw std::runtime_error("is cut off: its header has no end_header");
    guard(text.substr(0, end), "element ", text.size());
  }
  if (kind == "dae") {
    for (const std::string_view word : {"count=", "stride=", "offset="})
      guard(text, word, text.size());
  }
}

}  // namespace limpid
