// Menu bar, with the status at its end.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/desktop/scene/gallery.h"
#include "app/desktop/shell/desktop.h"
#include "app/desktop/widgets/picture_shelf.h"

namespace limpid {

// Menus of files: recent ones, with their pictures, and the shipped scenes.
class FileMenus {
 public:
  // Draws the recent files inside of a menu; returns the file that is chosen.
  std::filesystem::path draw(const std::vector<std::string>& recent);
  // Draws the shipped scenes likewise; `present`: the one that is open.
  std::filesystem::path draw_scenes(const std::string& present);
  void drop_pictures() { pictures_.clear(); }  // before the OpenGL context goes

  std::optional<std::size_t> to_open;  // menu of the bar to open in the next frame, by a key
  bool by_keys = false;                // keys lead through the open menu, not the mouse

 private:
  struct Entry {
    std::filesystem::path file, picture;
    bool there;
  };
  void look(const std::vector<std::string>& recent);

  // Contents as of the opening of the menu.
  std::vector<Entry> entries_;
  std::vector<GalleryCard> scenes_;
  PictureShelf pictures_;
};

void draw_menu_bar(Desktop& desktop, FileMenus& files);

// Name and contents of the menu for the selected object, or for the scene without a selection.
inline constexpr const char* kObjectMenu = "object menu";
void draw_object_menu(Desktop& desktop);

}  // namespace limpid
