// Pictures of files that are shown in a list, loaded when they are first asked for.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "app/desktop/widgets/picture_texture.h"

namespace limpid {

class PictureShelf {
 public:
  // Null where there is none that can be read. Needs a current OpenGL context.
  const PictureTexture* get(const std::filesystem::path& picture);
  // Before the OpenGL context goes, and to have them read anew.
  void clear() { pictures_.clear(); }

 private:
  std::map<std::filesystem::path, std::optional<PictureTexture>> pictures_;
};

struct PictureItem {
  const PictureTexture* picture;  // or null
  std::string name, about;        // two lines
  bool there = true;              // else greyed, and not to be chosen
};

// A line of a list with its picture at the left; true when it is chosen. `width` [px]; 0: all there
// is.
bool picture_item(const PictureItem& item, float width = 0);
// What it takes [px].
float picture_item_width(const PictureItem& item);

}  // namespace limpid
