#include "core/base/utf8.h"

#include <algorithm>
#include <cstdint>

namespace limpid {
namespace {

constexpr char32_t kReplacement = 0xFFFD;

void append(std::string& text, char32_t c) {
  const auto byte = [&text](char32_t x) { text += static_cast<char>(x); };
  if (c < 0x80) {
    byte(c);
  } else if (c < 0x800) {
    byte(0xC0 | c >> 6);
    byte(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    byte(0xE0 | c >> 12);
    byte(0x80 | (c >> 6 & 0x3F));
    byte(0x80 | (c & 0x3F));
  } else {
    byte(0xF0 | c >> 18);
    byte(0x80 | (c >> 12 & 0x3F));
    byte(0x80 | (c >> 6 & 0x3F));
    byte(0x80 | (c & 0x3F));
  }
}

// Bytes of the character that begins here; 0: this is not UTF-8.
std::size_t length_at(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xC2 && first < 0xE0   ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  // Overlong forms, halves of surrogate pairs, code points beyond the last one.
  const bool wrong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F) ||
                     (first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F);
  return wrong ? 0 : length;
}

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = length_at(text.substr(at));
    if (length == 0) return false;
    at += length;
  }
  return true;
}

std::string from_utf16(std::string_view bytes, bool big) {
  std::string text;
  text.reserve(bytes.size());
  const auto unit = [&](std::size_t at) {
    const auto one = static_cast<unsigned char>(bytes[at]);
    const auto two = static_cast<unsigned char>(bytes[at + 1]);
    return static_cast<char32_t>(big ? one << 8 | two : two << 8 | one);
  };
  for (std::size_t at = 0; at + 1 < bytes.size(); at += 2) {
    char32_t c = unit(at);
    if (c >= 0xD800 && c < 0xE000) {
      const char32_t low = c < 0xDC00 && at + 3 < bytes.size() ? unit(at + 2) : 0;
      const bool pair = low >= 0xDC00 && low < 0xE000;
      c = pair ? 0x10000 + ((c - 0xD800) << 10) + (low - 0xDC00) : kReplacement;
      if (pair) at += 2;
    }
    append(text, c);
  }
  return text;
}

// Makes an XML declaration, which still names the former encoding, say UTF-8.
void declare_utf8(std::string& text) {
  if (!text.starts_with("<?xml")) return;
  const std::size_t end = std::min(text.find("?>"), text.size());
  const std::size_t word = text.find("encoding", 5);
  if (word >= end) return;
  const std::size_t open = text.find_first_of("\"'", word);
  if (open >= end) return;
  const std::size_t close = text.find(text[open], open + 1);
  if (close < end) text.replace(open + 1, close - open - 1, "UTF-8");
}

}  // namespace

std::string utf8_of(std::string_view bytes) {
  using namespace std::string_view_literals;
  std::string text;
  if (bytes.starts_with("\xFF\xFE"sv) || bytes.starts_with("<\0"sv)) {
    text = from_utf16(bytes, false);
  } else if (bytes.starts_with("\xFE\xFF"sv) || bytes.starts_with("\0<"sv)) {
    text = from_utf16(bytes, true);
  } else if (!is_utf8(bytes)) {
    for (const char c : bytes) append(text, static_cast<unsigned char>(c));
  } else {
    return std::string(bytes.substr(bytes.starts_with("\xEF\xBB\xBF"sv) ? 3 : 0));
  }
  if (text.starts_with("\xEF\xBB\xBF"sv)) text.erase(0, 3);
  declare_utf8(text);
  return text;
}

std::size_t count_characters(std::string_view text) {
  // A character has one byte that does not continue another one.
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace limpid
