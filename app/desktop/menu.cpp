#include <fmt/format.h>

#include <algorithm>

#include "app/base/assets.h"
#include "app/desktop/panels.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "devices/files/config/config_file.h"

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

void file_menu(Workbench& bench, Window& window) {
  if (!ImGui::BeginMenu("File")) return;
  if (ImGui::MenuItem("Open session...", "Ctrl+O")) bench.dialog = Dialog::open_session;
  if (ImGui::MenuItem("Add model...", "Ctrl+M")) bench.dialog = Dialog::add_model;
  if (ImGui::MenuItem("Save scene", "Ctrl+S")) bench.save_scene();
  if (ImGui::MenuItem("Save scene as...", "Ctrl+Shift+S")) bench.dialog = Dialog::save_scene;
  if (ImGui::MenuItem("Save picture", "F12")) bench.save_picture(window);
  ImGui::Separator();
  if (ImGui::MenuItem("Undo", "Ctrl+Z")) bench.undo();
  if (ImGui::MenuItem("Redo", "Ctrl+Y")) bench.redo();
  if (ImGui::MenuItem("All settings as in the paper")) bench.reset_parameters();
  ImGui::Separator();
  if (ImGui::MenuItem("Quit", "Ctrl+Q")) window.close();
  ImGui::EndMenu();
}

void view_menu(Workbench& bench, Window& window) {
  if (!ImGui::BeginMenu("View")) return;
  Settings& s = bench.settings;
  ImGui::MenuItem("Coupling panel", "F2", &s.show_left);
  ImGui::MenuItem("Device panel", "F3", &s.show_right);
  ImGui::MenuItem("Plots", "F4", &s.show_plots);
  ImGui::Separator();
  ImGui::MenuItem("Ghost of the device", "G", &s.show_ghost);
  ImGui::MenuItem("Trail", nullptr, &s.show_trail);
  ImGui::MenuItem("Forces", nullptr, &s.show_forces);
  ImGui::MenuItem("Floor grid", nullptr, &s.show_grid);
  ImGui::Separator();
  if (ImGui::MenuItem("Front", "1")) bench.camera.look(Camera::View::front);
  if (ImGui::MenuItem("Side", "2")) bench.camera.look(Camera::View::side);
  if (ImGui::MenuItem("Top", "3")) bench.camera.look(Camera::View::top);
  if (ImGui::MenuItem("Reset camera", "0")) {
    bench.camera.reset(bench.shown().picture.bounds());
  }
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
  if (ImGui::MenuItem("Full screen", "F11", window.full_screen())) window.toggle_full_screen();
  ImGui::EndMenu();
}

void session_menu(Workbench& bench) {
  if (!ImGui::BeginMenu("Session")) return;
  const bool recording = bench.recording();
  if (ImGui::MenuItem(recording ? "Stop recording" : "Record", "R")) bench.toggle_recording();
  if (ImGui::MenuItem("Play or pause", "P")) bench.toggle_playing();
  if (ImGui::MenuItem("Re-run under present settings", "E", false, bench.playing_back())) {
    bench.start_rerun();
  }
  if (ImGui::MenuItem("Write as table (CSV)", nullptr, false,
                      bench.playing_back() && !bench.exporting.busy())) {
    bench.export_csv();
  }
  if (ImGui::MenuItem("Back to live", "Backspace", false, bench.playing_back())) {
    bench.close_playback();
  }
  ImGui::Separator();
  if (ImGui::MenuItem("Experiments of the paper...", "F5")) bench.dialog = Dialog::experiments;
  ImGui::EndMenu();
}

void scene_menu(Workbench& bench) {
  if (!ImGui::BeginMenu("Scene")) return;
  if (ImGui::MenuItem("Gallery...", "Ctrl+G")) bench.dialog = Dialog::gallery;
  ImGui::Separator();
  for (const fs::path& file : files_in(data_dir() / "assets/scenes", ".toml")) {
    if (ImGui::MenuItem(file.stem().string().c_str(), nullptr, bench.scene_file == file.string())) {
      bench.open_scene(file);
    }
  }
  ImGui::Separator();
  const bool any = bench.editor.selected().has_value() && !bench.playing_back();
  if (ImGui::MenuItem("Copy selected object", "Ctrl+D", false, any)) bench.duplicate_selected();
  if (ImGui::MenuItem("Remove selected object", "Delete", false, any)) bench.remove_selected();
  ImGui::Separator();
  ImGui::TextDisabled("Drop a model (.glb) or a scene (.toml) on the window.");
  ImGui::EndMenu();
}

void device_menu(Workbench& bench) {
  if (!ImGui::BeginMenu("Device")) return;
  ImGui::TextDisabled("%s, virtual, %d joints", bench.stage->arm().name.c_str(),
                      bench.stage->arm().dof());
  if (ImGui::MenuItem(bench.force_armed() ? "Force off" : "Force on",
                      bench.force_armed() ? "Esc" : "F")) {
    bench.toggle_force();
  }
  if (ImGui::MenuItem("Start over", "Backspace", false, !bench.playing_back())) bench.start_over();
  ImGui::EndMenu();
}

struct StatusPart {
  std::string text;
  Rgb ink;
  std::string help;
};

StatusPart force_part(const Workbench& bench) {
  const Palette& colours = current_palette();
  const Snapshot& now = bench.live.snapshot();
  const std::string why = explain(now.force_state);
  switch (now.arming) {
    case Arming::on: return {"force on [Esc]", colours.text, "Esc or space cut it at once"};
    case Arming::fading: return {"force fades [Esc]", colours.text, "Force: " + why};
    case Arming::waiting:
      return {"force waits [Esc]", colours.text, "It fades in with the hand: " + why};
    case Arming::tripped:
      return {"force off [F]", colours.broken, "Force is off: " + why + ". F arms it again."};
    case Arming::off: break;
  }
  return {"force off [F]", colours.muted, "F arms it"};
}

// Rate, missed ticks and coupling, the most important last.
std::vector<StatusPart> status_parts(Workbench& bench) {
  const Palette& colours = current_palette();
  const LoopStatus loop = bench.live.status();
  const Parameters& p = bench.parameters;
  const bool recorded = bench.playing_back();
  const auto row = bench.row();
  const RowLayout& layout = bench.shown().channels().layout();
  const auto kind = recorded ? static_cast<CouplingKind>(layout.in(row, Column::kind)[0]) : p.kind;
  const double eta = recorded ? layout.in(row, Column::eta)[0] : p.eta;
  const bool stopped = !loop.running;
  std::vector<StatusPart> parts;
  if (recorded) {
    const std::string file = bench.playback->file.filename().string();
    parts.push_back({"playing " + file, colours.text, file});
  }
  parts.push_back({stopped ? "loop stopped" : fmt::format("{:.0f} Hz", loop.rate),
                   stopped ? colours.broken : colours.muted, loop.failure});
  parts.push_back({fmt::format("{} missed", loop.missed),
                   loop.missed > loop.ticks / 100 ? colours.broken : colours.muted,
                   fmt::format("{} ticks missed: they began after the next one was due.\n{} began "
                               "more than 0.2 ms late, {} slipped: given up after a stall.",
                               loop.missed, loop.late, loop.slipped)});
  std::string law = info(kind).label;
  std::ranges::transform(law, law.begin(), [](unsigned char c) { return std::toupper(c); });
  if (info(kind).scales_inertia) law += fmt::format(" \xCE\xB7 {:.2f}", eta);
  parts.push_back({law, colours.text, "C switches"});
  return parts;
}

float status_width(const StatusPart& part) {
  return ImGui::CalcTextSize(part.text.c_str()).x + 1.4f * ImGui::GetFontSize();
}

// At the right-hand end of the menu bar as much as there is room for; the force is the last to go.
void status(Workbench& bench) {
  std::vector<StatusPart> parts = status_parts(bench);
  parts.push_back(force_part(bench));
  const float room = ImGui::GetWindowWidth() - ImGui::GetCursorPosX();
  float width = 0;
  auto first = parts.end();
  while (first != parts.begin()) {
    const float more = status_width(*std::prev(first));
    if (first != parts.end() && width + more > room) break;
    width += more;
    --first;
  }
  ImGui::SameLine(ImGui::GetWindowWidth() - width);
  for (; first != parts.end(); ++first) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(first->ink));
    ImGui::TextUnformatted(first->text.c_str());
    ImGui::PopStyleColor();
    if (!first->help.empty()) tooltip(first->help.c_str());
    ImGui::SameLine(0, 1.4f * ImGui::GetFontSize());
  }
}

void help_menu(Workbench& bench) {
  if (!ImGui::BeginMenu("Help")) return;
  if (ImGui::MenuItem("Keys and mouse", "?")) bench.dialog = Dialog::help;
  if (ImGui::MenuItem("About Limpid")) bench.dialog = Dialog::about;
  ImGui::EndMenu();
}

void menus(Workbench& bench, Window& window) {
  file_menu(bench, window);
  view_menu(bench, window);
  session_menu(bench);
  scene_menu(bench);
  device_menu(bench);
  help_menu(bench);
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

void draw_menu_bar(Workbench& bench, Window& window) {
  if (!ImGui::BeginMainMenuBar()) return;
  const bool room = menus_width() + status_width(force_part(bench)) < ImGui::GetWindowWidth();
  if (room) {
    menus(bench, window);
  } else if (ImGui::BeginMenu("Menu")) {
    menus(bench, window);
    ImGui::EndMenu();
  }
  status(bench);
  ImGui::EndMainMenuBar();
}

}  // namespace limpid
