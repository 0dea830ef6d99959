// Asks for a recording to open.
#pragma once

#include <filesystem>
#include <string>

#include "app/desktop/widgets/picture_shelf.h"
#include "app/desktop/widgets/widgets.h"

namespace limpid {

class SessionDialog {
 public:
  // While `open`. Returns the file once it is chosen, and clears `open`; so does whoever wants to
  // look in other folders: `elsewhere` is set then.
  std::filesystem::path draw(bool& open, bool& elsewhere);
  void drop_pictures() { pictures_.clear(); }  // before the OpenGL context goes

 private:
  std::filesystem::path list(const char* name, const std::filesystem::path& folder);

  PictureShelf pictures_;
  ListKeys keys_;
  int listed_ = 0;  // in the frame
  bool was_shown_ = false;
  std::string typed_, complaint_;
};

}  // namespace limpid
