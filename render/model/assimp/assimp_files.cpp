#include "render/model/assimp/assimp_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "core/base/utf8.h"

namespace limpid {

namespace {

// Bytes in memory, owned or borrowed.
class Stream : public Assimp::IOStream {
 public:
  explicit Stream(std::span<const unsigned char> bytes) : bytes_(bytes) {}
  explicit Stream(std::vector<unsigned char> own) : own_(std::move(own)), bytes_(own_) {}

  std::size_t Read(void* to, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
    if (whole > 0) std::memcpy(to, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t from = origin == aiOrigin_SET   ? 0
                             : origin == aiOrigin_CUR ? at_
                                                      : bytes_.size();
    if (offset > bytes_.size() - from) return aiReturn_FAILURE;
    at_ = from + offset;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::vector<unsigned char> own_;
  std::span<const unsigned char> bytes_;
  std::size_t at_ = 0;
};

std::string kind_of(const std::string& file) {
  const std::size_t dot = file.rfind('.');
  std::string kind = dot == std::string::npos ? "" : file.substr(dot + 1);
  std::ranges::transform(kind, kind.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return kind;
}

// Makes names portable: models made elsewhere name files as their own system does.
std::string portable(std::string file) {
  std::replace(file.begin(), file.end(), '\\', '/');
  while (file.starts_with("./")) file.erase(0, 2);
  return file;
}

std::string_view text_of(std::span<const unsigned char> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Returns the number that `text` begins with, 0 for none.
std::size_t number_in(std::string_view text) {
  while (!text.empty() && (text[0] == ' ' || text[0] == '\t' || text[0] == '"' || text[0] == '\''))
    text.remove_prefix(1);
  std::size_t number = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
  return end.ec == std::errc::result_out_of_range ? ~std::size_t{0} : number;
}

// Refuses a count behind a `word` in the text above `size`: each thing takes at least a byte.
void guard(std::string_view text, std::string_view word, std::size_t size) {
  for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    std::string_view rest = text.substr(at + word.size());
    if (word == "element ") {  // NAME NUMBER
      const auto end = rest.find_first_of(" \t\n");
      rest = end == rest.npos ? "" : rest.substr(end);
    }
    if (number_in(rest) > size)
      throw std::runtime_error("says that it has more data than a file of its size can have");
  }
}

constexpr std::string_view kBlanks = " \t\r\n";

std::string readable_dae(std::string_view text) {
  std::string out = utf8_of(text);
  out.erase(0, std::min(out.find_first_not_of(kBlanks), out.size()));
  return out;
}

// Passes each line, with its end, through `change`, which appends what becomes of it.
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
  std::string solid;  // text of the present solid so far
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

// Renames unknown elements in a binary file's header; puts a byte before data that begin with the
// end of a line.
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

// Tells text from binary STL as assimp does: a number of facets that fits the size means binary.
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

Assimp::IOStream* AssimpFiles::Open(const char* file, const char* mode) {
  if (std::strchr(mode, 'w') != nullptr) return nullptr;
  if (file == main_) return new Stream(bytes_);
  if (std::string_view(file).starts_with(kStem)) return nullptr;
  auto found = read(file);
  if (auto better = readable(found, kind_of(file))) found = std::move(*better);
  return found.empty() ? nullptr : new Stream(std::move(found));
}

std::vector<unsigned char> AssimpFiles::read(const std::string& file) {
  std::string why = " is missing";
  try {
    if (auto found = companions_.none() ? std::nullopt : companions_.read(portable(file))) {
      any_read_ = true;
      found_(found->size());
      return std::move(*found);
    }
  } catch (const std::runtime_error&) {
    why = " is outside the model's folder, or is too large";
  }
  warnings_.push_back("\"" + one_line(file) + "\"" + why + ", so it is ignored");
  return {};
}

void guard_counts(std::span<const unsigned char> bytes, const std::string& kind) {
  const std::string_view text = text_of(bytes);
  if (kind == "ply") {
    const auto end = text.find("end_header");
    if (end == text.npos) throw std::runtime_error("is not complete: its header has no end_header");
    guard(text.substr(0, end), "element ", text.size());
  }
  if (kind == "dae") {
    for (const std::string_view word : {"count=", "stride=", "offset="})
      guard(text, word, text.size());
  }
}

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
