// The scenes there are, as cards with pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/desktop/widgets/picture_shelf.h"
#include "app/desktop/widgets/widgets.h"

namespace limpid {

struct GalleryCard {
  std::filesystem::path scene;
  std::string title, about;
  std::filesystem::path picture;  // empty: none
  std::filesystem::path session;  // recorded in it; empty: none
};

// The scenes of a folder, by name; what cannot be read is there with its complaint.
std::vector<GalleryCard> gallery_of(const std::filesystem::path& folder,
                                    const std::filesystem::path& sessions);

class Gallery {
 public:
  // While `open`. The scene or session to open, once it is chosen; that clears `open`.
  std::filesystem::path draw(bool& open);
  void drop_pictures();  // before the OpenGL context goes

 private:
  void read();
  std::filesystem::path draw_card(const GalleryCard& card, bool own, float width, int number);

  ListKeys keys_;
  bool was_shown_ = false;
  std::vector<GalleryCard> shipped_, own_;
  PictureShelf pictures_;
};

}  // namespace limpid
