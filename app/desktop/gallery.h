// The scenes there are, as cards with pictures.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "app/desktop/picture_texture.h"
#include "app/desktop/workbench.h"

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
  void draw(Workbench& bench);
  void drop_pictures();  // before the OpenGL context goes

 private:
  void read();
  void draw_card(Workbench& bench, const GalleryCard& card, bool own, float width);
  const PictureTexture* picture(const std::filesystem::path& file);

  bool was_shown_ = false;
  std::vector<GalleryCard> shipped_, own_;
  std::map<std::filesystem::path, std::optional<PictureTexture>> pictures_;
};

}  // namespace limpid
