// The menu bar, with what is going on at its end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/desktop/shell/desktop.h"
#include "app/desktop/widgets/picture_shelf.h"

namespace limpid {

// The menu of files that were open last, with their pictures.
class RecentMenu {
 public:
  // Inside of a menu. The file that is chosen.
  std::filesystem::path draw(const std::vector<std::string>& recent);
  void drop_pictures() { pictures_.clear(); }  // before the OpenGL context goes

 private:
  struct Entry {
    std::filesystem::path file, picture;
    bool there;
  };
  void look(const std::vector<std::string>& recent);

  std::vector<Entry> entries_;  // as they were when the menu opened
  PictureShelf pictures_;
};

void draw_menu_bar(Desktop& desktop, RecentMenu& recent);

// What can be done with the selected object, or with the scene where nothing is selected; opened by
// this name.
inline constexpr const char* kObjectMenu = "object menu";
void draw_object_menu(Desktop& desktop);

}  // namespace limpid
