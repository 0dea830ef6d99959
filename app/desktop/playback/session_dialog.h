// Dialog that asks for a recording to open.
#pragma once

#include <filesystem>
#include <string>

#include "app/desktop/widgets/picture_shelf.h"
#include "app/desktop/widgets/widgets.h"

namespace limpid {

class SessionDialog {
 public:
  // Draws the dialog while `open`. Returns the file once it is chosen, and clears `open`. A wish to
  // look in other folders sets `elsewhere` and clears `open`, too.
  std::filesystem::path draw(bool& open, bool& elsewhere);
  void drop_pictures() { pictures_.clear(); }  // before the OpenGL context goes

 private:
  std::filesystem::path list(const char* name, const std::filesystem::path& folder);

  PictureShelf pictures_;
  ListKeys keys_;
  int listed_ = 0;  // number of items so far in this frame
  bool was_shown_ = false;
  std::string typed_, complaint_;
  std::filesystem::path first_;  // in the lists
};

}  // namespace limpid
