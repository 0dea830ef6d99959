#include "app/desktop/shell/menu.h"

#include <fmt/format.h>
#include <imgui.h>

#include <array>
#include <cctype>
#include <initializer_list>
#include <string>
#include <utility>

#include "app/base/folders.h"
#include "app/desktop/base/thumbnails.h"
#include "app/desktop/scene/object_signs.h"
#include "app/desktop/shell/commands.h"
#include "app/desktop/shell/status_line.h"
#include "app/desktop/widgets/modal.h"
#include "app/style/imgui_input.h"

namespace limpid {

namespace fs = std::filesystem;

namespace {

// Draws texts by name; returns the one that was clicked, empty for none.
std::string named_items(const NamedTexts& texts) {
  std::string chosen;
  for (const NamedTexts::Entry& entry : texts.all()) {
    if (ImGui::MenuItem(entry.name.c_str())) chosen = entry.name;
  }
  return chosen;
}

void presets(Desktop& d, FileMenus&) {
  if (const std::string name = named_items(d.tuning.presets); !name.empty())
    d.tuning.use_preset(name);
}

void layouts(Desktop& d, FileMenus&) {
  if (const std::string name = named_items(d.plots.layouts); !name.empty()) d.plots.use(name);
}

void recent_files(Desktop& d, FileMenus& files) {
  if (const fs::path chosen = files.draw(d.settings.recent); !chosen.empty()) {
    d.world.open_files({chosen});
  }
}

void shipped_scenes(Desktop& d, FileMenus& files) {
  ImGui::Separator();
  if (const fs::path chosen = files.draw_scenes(d.document.file()); !chosen.empty()) {
    d.world.open_scene(chosen);
  }
}

void about_drops(Desktop&, FileMenus&) {
  ImGui::Separator();
  ImGui::TextDisabled("Drop models, scenes, recordings or sweeps on the window.");
}

// Draws the choice of who has the hand: the virtual arm, or a device.
void arms(Desktop& d, FileMenus&) {
  const ArmDescription& arm = d.live.stage().arm();
  const std::string& in_use = d.devices.hub().in_use();
  const std::string virtual_arm = fmt::format("{}, virtual, {} joints", arm.name, arm.dof());
  if (ImGui::MenuItem(in_use.empty() ? virtual_arm.c_str() : "Virtual arm", nullptr,
                      in_use.empty())) {
    d.devices.use("");
  }
  for (const FoundDevice& found : d.devices.hub().found()) {
    ImGui::PushID(found.place.path.c_str());
    const bool here = found.place.id == in_use;
    if (ImGui::MenuItem(found.place.name.c_str(), nullptr, here, found.missing.empty())) {
      d.devices.use(found.place.id);
    }
    if (!found.missing.empty() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
      ImGui::SetTooltip("%s", found.missing.c_str());
    }
    ImGui::PopID();
  }
  ImGui::Separator();
}

// Draws a menu for each plot.
void plot_menus(Desktop& d, FileMenus&) {
  std::vector<Plot>& plots = d.shown.stage().plots;
  PlotWish wish = PlotWish::none;
  std::size_t of = 0;
  for (std::size_t i = 0; i < plots.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::BeginMenu(plots[i].spec().title.c_str())) {
      const PlotWish asked = plot_menu_items(true, true);
      if (asked != PlotWish::none) wish = asked, of = i;
      ImGui::EndMenu();
    }
    ImGui::PopID();
  }
  if (wish == PlotWish::none) return;
  d.settings.show_plots = true;
  plots[of].ask(wish);
}

// Part of a menu that is no command.
struct MenuPart {
  const char* menu;
  std::string_view behind;  // the id of a command; empty: at the top
  void (*draw)(Desktop&, FileMenus&);
};

constexpr std::array kParts{
    MenuPart{"File", "session.open", recent_files},
    MenuPart{"Edit/Presets of settings", "", presets},
    MenuPart{"View/Plots of", "", plot_menus},
    MenuPart{"View/Layouts", "", layouts},
    MenuPart{"Scene", "scene.gallery", shipped_scenes},
    MenuPart{"Scene", "scene.gallery", about_drops},
    MenuPart{"Device", "", arms},
};
constexpr std::array kMenus{"File", "Edit", "View", "Session", "Scene", "Device", "Help"};

// Begins a menu as ImGui does, and notes the place of its title while it is closed.
bool begin_menu(const char* title) {
  const bool open = ImGui::BeginMenu(title);
  if (!open) note_place(title);
  return open;
}

void draw_item(const Command& command, Desktop& d) {
  const std::string why = why_not(command, d);
  const Command::Label label =
      command.how.now != nullptr ? command.how.now(d) : Command::Label{command.text, nullptr};
  const std::string keys = label.keys != nullptr ? label.keys : key_text(command, *d.key_labels);
  const bool checked = command.how.checked != nullptr && command.how.checked(d);
  const bool chosen = ImGui::MenuItem(label.text, keys.c_str(), checked, why.empty());
  note_place(command.text);
  if (chosen) run_or_say(command.id, d);
  if (!why.empty() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
    ImGui::SetTooltip("%s", why.c_str());
  }
}

// Draws a menu. A menu inside of it stands at the place of its first command in the table.
void draw_menu(std::string_view menu, Desktop& d, FileMenus& files) {
  const auto draw_parts = [&](std::string_view behind) {
    for (const MenuPart& part : kParts) {
      if (part.menu == menu && part.behind == behind) part.draw(d, files);
    }
  };
  draw_parts("");
  std::string_view inner;
  for (const Command& command : commands()) {
    const std::string_view of = command.menu != nullptr ? command.menu : "";
    if (of == menu) {
      if (command.how.apart) ImGui::Separator();
      draw_item(command, d);
      draw_parts(command.id);
    } else if (of != inner && of.starts_with(std::string(menu) + "/")) {
      inner = of;
      const std::string title(inner.substr(menu.size() + 1));
      if (!begin_menu(title.c_str())) continue;
      draw_menu(inner, d, files);
      ImGui::EndMenu();
    }
  }
}

// Draws all menus; returns the one that is open, if any.
std::optional<std::size_t> draw_menus(Desktop& d, FileMenus& files) {
  // A key's menu opens before the others are drawn: they share a window, which belongs to one a
  // frame.
  if (files.to_open) ImGui::OpenPopup(kMenus[*files.to_open]);
  files.to_open.reset();
  std::optional<std::size_t> open;
  for (std::size_t i = 0; i < kMenus.size(); ++i) {
    if (!begin_menu(kMenus[i])) continue;
    open = i;
    draw_menu(kMenus[i], d, files);
    ImGui::EndMenu();
  }
  return open;
}

// Draws menus side by side; arrow keys go from one to the next.
void draw_bar_of_menus(Desktop& d, FileMenus& files) {
  const int before = menus_open();
  const auto open = draw_menus(d, files);
  const int step = open ? step_to_menu_beside(before) : 0;
  // The step before the first menu leads to the last one.
  const std::size_t on = step > 0 ? 1 : kMenus.size() - 1;
  if (step != 0) files.to_open = (*open + on) % kMenus.size();
}

// Returns the width of all menus side by side.
float menus_width() {
  float width = ImGui::GetStyle().WindowPadding.x;
  for (const char* menu : kMenus) {
    width += ImGui::CalcTextSize(menu).x + 2 * ImGui::GetStyle().ItemSpacing.x;
  }
  return width;
}

}  // namespace

void FileMenus::look(const std::vector<std::string>& recent) {
  pictures_.clear();
  entries_.clear();
  for (const std::string& name : recent) {
    std::error_code none;
    entries_.push_back({name, picture_of(name), fs::is_regular_file(name, none)});
  }
}

fs::path FileMenus::draw(const std::vector<std::string>& recent) {
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

fs::path FileMenus::draw_scenes(const std::string& present) {
  if (ImGui::IsWindowAppearing()) {
    scenes_ = gallery_of(data_dir() / "assets/scenes", data_dir() / "assets/sessions");
  }
  fs::path chosen;
  for (const GalleryCard& card : scenes_) {
    if (ImGui::MenuItem(card.title.c_str(), nullptr, card.scene == present)) chosen = card.scene;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", card.about.c_str());
  }
  return chosen;
}

void draw_object_menu(Desktop& d) {
  if (!ImGui::BeginPopup(kObjectMenu)) return;
  const auto items = [&](std::initializer_list<const char*> ids) {
    for (const char* id : ids) draw_item(*find_command(id), d);
  };
  if (const Object* selected = d.document.editor().selected_object()) {
    ImGui::TextDisabled("%s", selected->name.c_str());
    items({"object.move", "object.turn", "object.scale"});
    ImGui::Separator();
    items({"scene.copy", "scene.remove", "scene.look"});
    ImGui::Separator();
    if (ImGui::MenuItem("Material, size, joint...")) d.settings.show_right = true;
  } else {
    for (const NewObject& each : new_objects()) {
      if (each.first_that_moves) ImGui::Separator();
      std::string label = std::string("Add ") + each.label;
      label[4] = static_cast<char>(std::tolower(label[4]));
      const std::string why = d.document.why_fixed();
      if (ImGui::MenuItem(label.c_str(), nullptr, false, why.empty()))
        d.world.add_object(each.object);
    }
    ImGui::Separator();
    items({"scene.add_model", "view.reset"});
  }
  ImGui::EndPopup();
}

void draw_menu_bar(Desktop& desktop, FileMenus& files) {
  if (!ImGui::BeginMainMenuBar()) return;
  const LiveLoop& loop = desktop.live.loop();
  if (std::exchange(desktop.asked.menu, false)) {
    files.to_open = 0;
    files.by_keys = true;
  }
  const ImVec2 moved = ImGui::GetIO().MouseDelta;
  if ((menus_open() == 0 && !files.to_open) || moved.x != 0 || moved.y != 0) files.by_keys = false;
  if (files.by_keys) show_chosen_item();
  constexpr const char* kAll = "Menu";
  if (menus_width() + least_status_width(loop) < ImGui::GetWindowWidth()) {
    draw_bar_of_menus(desktop, files);
  } else {
    if (std::exchange(files.to_open, std::nullopt)) ImGui::OpenPopup(kAll);
    if (ImGui::BeginMenu(kAll)) {
      draw_menus(desktop, files);
      ImGui::EndMenu();
    }
  }
  const Parameters& p = desktop.settings.parameters();
  StatusLaw law{p.kind, p.eta};
  std::string played;
  if (const PlayedSession* session = desktop.playback.shown()) {
    const RowLayout& layout = session->stage().channels().layout();
    law.kind = static_cast<CouplingKind>(layout.in(desktop.shown.row(), Column::kind)[0]);
    law.eta = layout.in(desktop.shown.row(), Column::eta)[0];
    played = session->file().filename().string();
  }
  draw_status(loop, law,
              {played, played.empty() ? desktop.live.pace_text() : "", desktop.lead.on()});
  ImGui::EndMainMenuBar();
}

}  // namespace limpid
