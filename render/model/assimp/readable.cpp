#include "render/model/assimp/readable.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/base/utf8.h"

namespace limpid {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::string readable_dae(std::string_view text) {
  std::string out = utf8_of(text);
  out.erase(0, std::min(out.find_first_not_of(kBlanks), out.size()));
  return out;
}

// Each line, with its end, through `change`, which appends what becomes of it.
template <class Change>
std::string by_lines(std::string_view text, Change change) {
  std::string out;
  out.reserve(text.size() + text.size() / 16);
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::size_t length = end == text.npos ? text.size() : end + 1;
    change(text.substr(0, length), out);
    text.remove_prefix(length);
  }
  return out;
}

std::string_view first_word(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  return line.substr(0, line.find_first_of(kBlanks));
}

std::string readable_mtl(std::string_view text) {
  return by_lines(text, [](std::string_view line, std::string& out) {
    if (!first_word(line).starts_with("aniso")) out += line;
  });
}

std::string readable_obj(std::string_view text) {
  return by_lines(text, [](std::string_view line, std::string& out) {
    const bool numbers = first_word(line).starts_with('v');
    char before = '\0';
    for (const char c : line) {
      if (numbers && c == '.' && (before == ' ' || before == '\t')) out += '0';
      out += before = c;
    }
  });
}

std::string readable_stl(std::string_view text) {
  std::string solid;  // as far as it has come
  bool empty = true;
  std::string out = by_lines(text, [&](std::string_view line, std::string& done) {
    const std::string_view word = first_word(line);
    solid += line;
    empty = empty && !word.starts_with('f') && !word.starts_with('F');  // facet
    if (word != "endsolid") return;
    if (!empty) done += solid;
    solid.clear();
    empty = true;
  });
  out += solid;
  return first_word(out).empty() ? std::string(text) : out;
}

// The header of a binary file, renamed; its data, behind a byte that is no end of a line.
std::string readable_ply(std::string_view text) {
  constexpr std::array<std::string_view, 5> kKnown{"vertex", "face", "tristrips", "edge",
                                                   "material"};
  const std::size_t end = text.find("end_header");
  const std::size_t line_end = text.find('\n', std::min(end, text.size()));
  if (line_end == text.npos) return std::string(text);
  const std::string_view data = text.substr(line_end + 1);
  const bool skipped = data.starts_with('\n') || data.starts_with('\r');
  bool padded = false;
  std::string out =
      by_lines(text.substr(0, line_end + 1), [&](std::string_view line, std::string& header) {
        if (first_word(line) != "element") {
          header += line;
          return;
        }
        if (skipped && !padded) header += "element edge 1\nproperty uchar pad\n";
        padded = true;
        const std::size_t at = line.find("element") + 7;
        const std::string_view name = first_word(line.substr(at));
        if (name.empty() || std::ranges::find(kKnown, name) != kKnown.end()) {
          header += line;
        } else {
          header += "element edge";
          header += line.substr(line.find(name, at) + name.size());
        }
      });
  if (skipped && padded) out += '-';
  return out += data;
}

bool is_binary_ply(std::string_view text) {
  return text.substr(0, text.find("end_header")).find("format binary") != text.npos;
}

// As assimp tells it: a number of facets that fits says that it is no text.
bool is_text_stl(std::string_view text) {
  if (!text.starts_with("solid")) return false;
  constexpr std::size_t kHeader = 84, kFacet = 50;
  if (text.size() < kHeader) return true;
  std::size_t facets = 0;
  for (std::size_t i = 4; i-- > 0;) {
    facets = facets << 8 | static_cast<unsigned char>(text[80 + i]);
  }
  return text.size() != kHeader + kFacet * facets;
}

}  // namespace

std::optional<std::vector<unsigned char>> readable(std::span<const unsigned char> bytes,
                                                   const std::string& kind) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::string out;
  if (kind == "dae") {
    out = readable_dae(text);
  } else if (kind == "mtl") {
    out = readable_mtl(text);
  } else if (kind == "obj") {
    out = readable_obj(text);
  } else if (kind == "ply" && is_binary_ply(text)) {
    out = readable_ply(text);
  } else if (kind == "stl" && is_text_stl(text)) {
    out = readable_stl(text);
  } else {
    return std::nullopt;
  }
  return std::vector<unsigned char>(out.begin(), out.end());
}

}  // namespace limpid
