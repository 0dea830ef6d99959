#include "devices/files/arm/xml_guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "devices/files/file_error.h"

namespace limpid {
namespace {

constexpr int kDeepestXml = 100;
constexpr int kMostAttributes = 1000;  // of an element

// Reads what TinyXML reads, element by element, and stops where it stops.
class Guard {
 public:
  Guard(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  void look_through() {
    for (at_ = text_.find('<'); at_ < text_.size(); at_ = text_.find('<', at_)) {
      const auto next = static_cast<unsigned char>(at_ + 1 < text_.size() ? text_[at_ + 1] : '\0');
      if (stands_here("<!--")) {
        skip_behind("-->", 4);
      } else if (stands_here("<![CDATA[")) {
        skip_behind("]]>", 9);
      } else if (next == '?') {
        skip_instruction();
      } else if (next == '/') {
        depth_ = std::max(depth_ - 1, 0);
        skip_behind(">", 2);
      } else if (std::isalpha(next) || next == '_' || next >= 127) {
        read_element();
      } else {
        skip_behind(">", 1);
      }
    }
  }

 private:
  bool stands_here(std::string_view word) const { return text_.substr(at_, word.size()) == word; }

  void skip_behind(std::string_view end, std::size_t begun) {
    const std::size_t found = text_.find(end, at_ + begun);
    at_ = found == std::string_view::npos ? text_.size() : found + end.size();
  }

  // TinyXML takes a '>' inside of quotes for a part of some attributes of <?xml ...?> and not of
  // others; neither it nor '<' has a place there.
  void skip_instruction() {
    const std::size_t end = text_.find("?>", at_);
    if (end != std::string_view::npos &&
        text_.substr(at_ + 1, end - at_ - 1).find_first_of("<>") != std::string_view::npos) {
      refuse("'<' or '>' between '<?' and '?>'");
    }
    skip_behind(">", 1);
  }

  // Values stand in quotes and may hold anything else.
  void read_element() {
    int attributes = 0;
    for (++at_; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        at_ = std::min(text_.find(c, at_ + 1), text_.size());
      } else if (c == '=') {
        if (++attributes > kMostAttributes) refuse("too many attributes in an element");
      } else if (c == '>') {
        if (text_[at_ - 1] != '/' && ++depth_ > kDeepestXml) refuse("XML nested too deep");
        return;
      }
    }
  }

  [[noreturn]] void refuse(const char* why) const {
    const auto lines =
        std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    throw FileError(fmt::format("{}:{}: {}", where_, lines + 1, why));
  }

  std::string_view text_;
  const std::string& where_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

void check_xml(const std::string& text, const std::string& where) {
  if (text.size() > kLongestXml) {
    throw FileError(
        fmt::format("{}: {} bytes long, at most {} are read", where, text.size(), kLongestXml));
  }
  Guard(text, where).look_through();
}

}  // namespace limpid
