// The menu bar, with what is going on at its end.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/desktop/panels/gallery.h"
#include "app/desktop/shell/desktop.h"
#include "app/desktop/widgets/picture_shelf.h"

namespace limpid {

// Menus of files: those that were open last, with their pictures, and the shipped scenes.
class FileMenus {
 public:
  // Inside of a menu. The file that is chosen.
  std::filesystem::path draw(const std::vector<std::string>& recent);
  // The same of the shipped scenes; `present`: the one that is open.
  std::filesystem::path draw_scenes(const std::string& present);
  void drop_pictures() { pictures_.clear(); }  // before the OpenGL context goes

  std::optional<std::size_t> to_open;  // of the bar, in the next frame, by a key
  bool by_keys = false;                // keys lead through the menu that is open, not the mouse

 private:
  struct Entry {
    std::filesystem::path file, picture;
    bool there;
  };
  void look(const std::vector<std::string>& recent);

  // As they were when the menu opened.
  std::vector<Entry> entries_;
  std::vector<GalleryCard> scenes_;
  PictureShelf pictures_;
};

void draw_menu_bar(Desktop& desktop, FileMenus& files);

// What can be done with the selected object, or with the scene where nothing is selected; opened by
// this name.
inline constexpr const char* kObjectMenu = "object menu";
void draw_object_menu(Desktop& desktop);

}  // namespace limpid
