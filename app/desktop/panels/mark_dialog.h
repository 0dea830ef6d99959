// Asks what a mark says, in a line.
#pragma once

#include <optional>
#include <string>

namespace limpid {

// What came of it in this frame.
struct MarkAnswer {
  std::optional<std::string> text = {};  // it says this from now on
  bool remove = false;
};

class MarkDialog {
 public:
  // While `open`. `when`: for people; `text`: what it says, or would; `there`: the mark is there
  // already and can be removed.
  MarkAnswer draw(bool& open, const std::string& when, const std::string& text, bool there);

 private:
  bool was_open_ = false;
  std::string text_;
};

}  // namespace limpid
