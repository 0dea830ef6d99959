// Dialog that asks for a mark's text.
#pragma once

#include <optional>
#include <string>

namespace limpid {

// Answer of a frame.
struct MarkAnswer {
  std::optional<std::string> text = {};  // new text of the mark
  bool remove = false;
};

class MarkDialog {
 public:
  // Draws the dialog while `open`. `when`: for people; `text`: of the mark, or a proposal; `there`:
  // the mark exists and can be removed.
  MarkAnswer draw(bool& open, const std::string& when, const std::string& text, bool there);

 private:
  bool was_open_ = false;
  std::string text_;
};

}  // namespace limpid
