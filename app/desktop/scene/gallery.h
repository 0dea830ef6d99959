// Gallery of all scenes, as cards with pictures.
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
  std::filesystem::path session;  // session recorded in the scene; empty: none
};

// Returns the scenes of a folder, by name; an unreadable one has its complaint as text.
std::vector<GalleryCard> gallery_of(const std::filesystem::path& folder,
                                    const std::filesystem::path& sessions);

class Gallery {
 public:
  // Draws the gallery while `open`. Returns the scene or session to open once it is chosen, and
  // clears `open`.
  std::filesystem::path draw(bool& open);
  void drop_pictures();  // before the OpenGL context goes

 private:
  void read();
  std::filesystem::path draw_card(const GalleryCard& card, bool own, float width, int number);

  ListKeys keys_;
  bool was_shown_ = false;
  std::string typed_;
  std::vector<GalleryCard> shipped_, own_;
  PictureShelf pictures_;
};

}  // namespace limpid
