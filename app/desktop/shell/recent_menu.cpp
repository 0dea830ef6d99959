#include "app/desktop/shell/recent_menu.h"

#include <imgui.h>

#include <algorithm>

#include "app/desktop/base/thumbnails.h"

namespace limpid {

namespace fs = std::filesystem;

void RecentMenu::look(const std::vector<std::string>& recent) {
  pictures_.clear();
  entries_.clear();
  for (const std::string& name : recent) {
    std::error_code none;
    entries_.push_back({name, picture_of(name), fs::is_regular_file(name, none)});
  }
}

fs::path RecentMenu::draw(const std::vector<std::string>& recent) {
  if (!ImGui::BeginMenu("Open recent", !recent.empty())) return {};
  if (ImGui::IsWindowAppearing()) look(recent);
  std::vector<PictureItem> items;
  float width = 0;
  for (const Entry& entry : entries_) {
    const std::string folder = entry.file.parent_path().string();
    items.push_back({.picture = pictures_.get(entry.picture),
                     .name = entry.file.filename().string(),
                     .about = entry.there ? folder : "no longer there: " + folder,
                     .there = entry.there});
    width = std::max(width, picture_item_width(items.back()));
  }
  fs::path chosen;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (picture_item(items[i], width)) chosen = entries_[i].file;
  }
  ImGui::EndMenu();
  return chosen;
}

}  // namespace limpid
