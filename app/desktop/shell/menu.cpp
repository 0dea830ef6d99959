#include "app/desktop/shell/menu.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "app/base/folders.h"
#include "app/desktop/panels/status_line.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& dir, const std::string& extension) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(dir, none)) {
    if (entry.path().extension() == extension) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

// What is kept by name; the one that was clicked, empty for none.
std::string named_items(const NamedTexts& texts) {
  std::string chosen;
  for (const NamedTexts::Entry& entry : texts.all()) {
    if (ImGui::MenuItem(entry.name.c_str())) chosen = entry.name;
  }
  if (!texts.all().empty()) ImGui::Separator();
  return chosen;
}

// An item that has an action carried out.
void item(const char* label, const char* keys, Action action, const Act& act, bool enabled = true) {
  if (ImGui::MenuItem(label, keys, false, enabled)) act(action);
}

void file_menu(Desktop& d, RecentMenu& recent, const Act& act) {
  if (!ImGui::BeginMenu("File")) return;
  item("Open session or sweep...", "Ctrl+O", Action::open_session, act);
  const fs::path chosen = recent.draw(d.settings().recent);
  item("Add model...", "Ctrl+M", Action::add_model, act);
  item("Save scene", "Ctrl+S", Action::save_scene, act);
  item("Save scene as...", "Ctrl+Shift+S", Action::save_scene_as, act);
  item("Save picture", "F12", Action::save_picture, act);
  ImGui::Separator();
  item("Undo", "Ctrl+Z", Action::undo, act);
  item("Redo", "Ctrl+Y", Action::redo, act);
  if (ImGui::MenuItem("All settings to their usual values")) d.reset_parameters();
  if (ImGui::BeginMenu("Presets of settings")) {
    if (const std::string name = named_items(d.presets()); !name.empty()) d.use_preset(name);
    item("Save, rename...", "Ctrl+P", Action::presets, act);
    ImGui::EndMenu();
  }
  ImGui::Separator();
  item("Quit", "Ctrl+Q", Action::quit, act);
  ImGui::EndMenu();
  if (!chosen.empty()) d.open_files({chosen});
}

// One of the plots, with all that can be done with it.
void plot_menus(Desktop& d) {
  std::vector<Plot>& plots = d.shown().plots;
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
  d.settings().show_plots = true;
  plots[of].ask(wish);
}

void plots_menu(Desktop& d, const Act& act) {
  if (ImGui::BeginMenu("Plots of")) {
    plot_menus(d);
    ImGui::Separator();
    item("Add a plot...", "N", Action::add_plot, act);
    ImGui::EndMenu();
  }
  if (ImGui::BeginMenu("Layouts")) {
    if (const std::string name = named_items(d.layouts()); !name.empty()) d.use_layout(name);
    item("Save, rename...", "Ctrl+L", Action::layouts, act);
    ImGui::EndMenu();
  }
}

void view_menu(Desktop& d, bool full_screen, const Act& act) {
  if (!ImGui::BeginMenu("View")) return;
  Settings& s = d.settings();
  ImGui::MenuItem("Coupling panel", "F2", &s.show_left);
  ImGui::MenuItem("Device panel", "F3", &s.show_right);
  ImGui::MenuItem("Plots", "F4", &s.show_plots);
  plots_menu(d, act);
  ImGui::Separator();
  ImGui::MenuItem("Ghost of the device", "G", &s.show_ghost);
  ImGui::MenuItem("Lens at the tip, x5", "M", &s.show_lens);
  ImGui::MenuItem("Trail", nullptr, &s.show_trail);
  ImGui::MenuItem("Forces", nullptr, &s.show_forces);
  ImGui::MenuItem("Floor grid", nullptr, &s.show_grid);
  ImGui::MenuItem("Axes of the joints", nullptr, &s.show_joints);
  ImGui::MenuItem("Twin in one picture", "Shift+B", &s.twin_overlaid);
  ImGui::Separator();
  item("Front", "1", Action::front_view, act);
  item("Side", "2", Action::side_view, act);
  item("Top", "3", Action::top_view, act);
  item("Reset camera", "0", Action::reset_camera, act);
  ImGui::Separator();
  bool light = s.theme == Theme::light;
  if (ImGui::MenuItem("Light theme", nullptr, &light)) {
    s.theme = light ? Theme::light : Theme::dark;
    apply_theme(s.theme, current_scale());
  }
  if (ImGui::BeginMenu("Picture quality")) {
    for (const char* choice : {"automatic", "high", "medium", "low"}) {
      if (ImGui::MenuItem(choice, nullptr, s.picture_quality == choice)) s.picture_quality = choice;
    }
    ImGui::EndMenu();
  }
  if (ImGui::MenuItem("Full screen", "F11", full_screen)) act(Action::full_screen);
  ImGui::EndMenu();
}

void session_menu(Desktop& d, const Act& act) {
  if (!ImGui::BeginMenu("Session")) return;
  Playback& playback = d.playback();
  item(d.desk().recording() ? "Stop recording" : "Record", "R", Action::toggle_recording, act);
  item("Play or pause", "P", Action::toggle_playing, act);
  if (ImGui::MenuItem("Twin: two couplings on one hand", "B", d.settings().twin.on)) {
    act(Action::toggle_twin);
  }
  item("Re-run under present settings", "E", Action::rerun, act, playback.on());
  if (ImGui::MenuItem("Write as table (CSV)", nullptr, false,
                      playback.on() && !playback.exporting())) {
    playback.export_csv();
  }
  item("Write as video...", "V", Action::write_video, act,
       playback.on() && !playback.video().busy());
  item("Back to live", "Backspace", Action::back_to_live, act, playback.on());
  ImGui::Separator();
  if (ImGui::MenuItem("Experiments of the paper...", "F5")) d.open_dialog(Dialog::experiments);
  item("Map of the sweep", "F6", Action::toggle_sweep, act);
  ImGui::EndMenu();
}

void scene_menu(Desktop& d, const Act& act) {
  if (!ImGui::BeginMenu("Scene")) return;
  item("Gallery...", "Ctrl+G", Action::gallery, act);
  ImGui::Separator();
  for (const fs::path& file : files_in(data_dir() / "assets/scenes", ".toml")) {
    const bool present = d.document().file() == file.string();
    if (ImGui::MenuItem(file.stem().string().c_str(), nullptr, present)) d.open_scene(file);
  }
  ImGui::Separator();
  const bool any = d.document().editor().selected().has_value() && !d.playback().on();
  item("Copy selected object", "Ctrl+D", Action::duplicate_selected, act, any);
  item("Remove selected object", "Delete", Action::remove_selected, act, any);
  ImGui::Separator();
  ImGui::TextDisabled("Drop models, scenes, recordings or sweeps on the window.");
  ImGui::EndMenu();
}

void device_menu(Desktop& d, const Act& act) {
  if (!ImGui::BeginMenu("Device")) return;
  const ArmDescription& arm = d.desk().stage().arm();
  ImGui::TextDisabled("%s, virtual, %d joints", arm.name.c_str(), arm.dof());
  item("Open arm (URDF)...", nullptr, Action::open_arm, act, !d.desk().loop().device_in_place());
  if (ImGui::MenuItem("Built-in arm", nullptr, d.built_in_arm())) d.use_built_in_arm();
  item("Identify...", "F7", Action::toggle_identify, act);
  ImGui::Separator();
  const bool armed = d.desk().force_armed();
  item(armed ? "Force off" : "Force on", armed ? "Esc" : "F", Action::toggle_force, act);
  item("Start over", "Backspace", Action::start_over, act, !d.playback().on());
  ImGui::EndMenu();
}

void help_menu(Desktop& d) {
  if (!ImGui::BeginMenu("Help")) return;
  if (ImGui::MenuItem("Play the story")) d.play_story();
  if (ImGui::MenuItem("Keys and mouse", "?")) d.open_dialog(Dialog::help);
  if (ImGui::MenuItem("About Limpid")) d.open_dialog(Dialog::about);
  ImGui::EndMenu();
}

void menus(Desktop& d, RecentMenu& recent, bool full_screen, const Act& act) {
  file_menu(d, recent, act);
  view_menu(d, full_screen, act);
  session_menu(d, act);
  scene_menu(d, act);
  device_menu(d, act);
  help_menu(d);
}

// Of all menus side by side.
float menus_width() {
  float width = ImGui::GetStyle().WindowPadding.x;
  for (const char* menu : {"File", "View", "Session", "Scene", "Device", "Help"}) {
    width += ImGui::CalcTextSize(menu).x + 2 * ImGui::GetStyle().ItemSpacing.x;
  }
  return width;
}

}  // namespace

void draw_menu_bar(Desktop& desktop, RecentMenu& recent, bool full_screen, const Act& act) {
  if (!ImGui::BeginMainMenuBar()) return;
  const LiveLoop& loop = desktop.desk().loop();
  if (menus_width() + least_status_width(loop) < ImGui::GetWindowWidth()) {
    menus(desktop, recent, full_screen, act);
  } else if (ImGui::BeginMenu("Menu")) {
    menus(desktop, recent, full_screen, act);
    ImGui::EndMenu();
  }
  const Parameters& p = desktop.settings().parameters;
  StatusLaw law{p.kind, p.eta};
  std::string played;
  if (const PlayedSession* session = desktop.playback().shown()) {
    const RowLayout& layout = session->stage().channels().layout();
    law.kind = static_cast<CouplingKind>(layout.in(desktop.row(), Column::kind)[0]);
    law.eta = layout.in(desktop.row(), Column::eta)[0];
    played = session->file().filename().string();
  }
  draw_status(loop, law, played);
  ImGui::EndMainMenuBar();
}

}  // namespace limpid
