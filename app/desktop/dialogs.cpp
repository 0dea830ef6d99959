#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "app/base/assets.h"
#include "app/desktop/keys.h"
#include "app/desktop/modal.h"
#include "app/desktop/panels.h"
#include "app/desktop/path_dialog.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// Something to read: the window behind it goes on. Pairs with ImGui::End().
void begin_reading(Workbench& bench, const char* title, float width) {
  const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
  bool open = true;
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {0.96f * room.x, 0.9f * room.y});
  ImGui::SetNextWindowSize({std::min(width * ImGui::GetFontSize(), 0.96f * room.x), 0});
  ImGui::Begin(
      title, &open,
      ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoResize);
  if (!open || accepted()) bench.dialog = Dialog::none;
}

// The recordings of a folder, newest names first; the one that was clicked.
fs::path list_sessions(const char* name, const fs::path& dir) {
  heading(name);
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(dir, none)) {
    if (entry.path().extension() == ".h5") files.push_back(entry.path());
  }
  std::ranges::sort(files, std::greater{});
  if (files.empty()) ImGui::TextDisabled("none yet");
  fs::path chosen;
  for (const fs::path& file : files) {
    const double mib = static_cast<double>(fs::file_size(file, none)) / (1 << 20);
    const std::string text = fmt::format("{}   {:.1f} MiB", file.filename().string(), mib);
    if (ImGui::Selectable(text.c_str())) chosen = file;
  }
  return chosen;
}

}  // namespace

void SessionDialog::draw(Workbench& bench) {
  const bool wanted = bench.dialog == Dialog::open_session;
  bool open = wanted;
  const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
  const float em = ImGui::GetFontSize();
  const bool shown = begin_modal("Open session", open, {std::min(34 * em, 0.94f * room.x), 0});
  if (wanted && !open) bench.dialog = Dialog::none;
  if (!shown) {
    was_shown_ = false;
    return;
  }
  if (!was_shown_) typed_ = complaint_ = "";
  ImGui::SetNextItemWidth(-1);
  if (!was_shown_) ImGui::SetKeyboardFocusHere();
  was_shown_ = true;
  fs::path chosen;
  const std::string before = typed_;
  if (ImGui::InputTextWithHint("##path", "type a path and press Enter; dropping a file works too",
                               &typed_, ImGuiInputTextFlags_EnterReturnsTrue) ||
      accepted()) {
    chosen = expanded(typed_);
  }
  if (typed_ != before) complaint_.clear();
  if (!complaint_.empty()) {
    ImGui::TextColored(colour_vector(current_palette().broken), "%s", complaint_.c_str());
  }
  ImGui::BeginChild("sessions", {0, std::min(20 * em, 0.55f * room.y)});
  for (const auto& [name, dir] : {std::pair{"Yours", sessions_dir()},
                                  {"Shipped with Limpid", data_dir() / "assets/sessions"}}) {
    if (const fs::path clicked = list_sessions(name, dir); !clicked.empty()) chosen = clicked;
  }
  ImGui::EndChild();
  ImGui::EndPopup();
  std::error_code none;
  if (chosen.empty()) return;
  if (!fs::is_regular_file(chosen, none)) {
    complaint_ = "There is no such file.";
    return;
  }
  bench.dialog = Dialog::none;
  bench.open_session(chosen);
}

namespace {

void draw_help(Workbench& bench) {
  begin_reading(bench, "Keys and mouse", 46);
  if (ImGui::BeginTable("keys", 2)) {
    ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthFixed, 13 * ImGui::GetFontSize());
    for (const Shortcut& shortcut : shortcuts()) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(shortcut.keys);
      ImGui::TableNextColumn();
      ImGui::TextWrapped("%s", shortcut.what);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

void draw_about(Workbench& bench) {
  begin_reading(bench, "About Limpid", 34);
  ImGui::PushFont(font(Face::semibold));
  ImGui::TextUnformatted("Limpid " LIMPID_VERSION);
  ImGui::PopFont();
  ImGui::TextWrapped(
      "Touch a virtual world through a haptic device and see, tick by tick, how transparent the "
      "coupling between hand and world is.");
  ImGui::Spacing();
  ImGui::TextWrapped(
      "The proposed coupling is that of \"Improving transparency of virtual coupling for haptic "
      "interaction with human force observer\"; numbers in parentheses are its equations. Please "
      "cite the paper when you publish what you measured here.");
  ImGui::Spacing();
  ImGui::TextWrapped(
      "Built on GLFW, Dear ImGui, Eigen, GLM, tinygltf, HDF5, urdfdom and fmt. Text "
      "is set in Inter (SIL Open Font License).");
  ImGui::End();
}

}  // namespace

void draw_dialogs(Workbench& bench) {
  if (bench.dialog == Dialog::help) draw_help(bench);
  if (bench.dialog == Dialog::about) draw_about(bench);
}

void draw_notices(Workbench& bench, const ScreenRect& view) {
  const Palette& colours = palette(current_theme());
  ImDrawList* draw = ImGui::GetForegroundDrawList();
  float y = view.min.y + 0.7f * ImGui::GetFontSize();
  for (const Notice& notice : bench.notices) {
    const float wrap = 0.7f * view.size().x;
    const ImVec2 size = ImGui::CalcTextSize(notice.text.c_str(), nullptr, false, wrap);
    const float pad = 0.5f * ImGui::GetFontSize();
    const ImVec2 at((view.min.x + view.max.x - size.x) / 2, y + pad);
    const ImVec2 from(at.x - pad, at.y - pad), to(at.x + size.x + pad, at.y + size.y + pad);
    draw->AddRectFilled(from, to, colour(colours.raised, 0.95f), 4);
    draw->AddRect(from, to, colour(notice.bad ? colours.broken : colours.border), 4);
    draw->AddText(ImGui::GetFont(), ImGui::GetFontSize(), at, colour(colours.text),
                  notice.text.c_str(), nullptr, wrap);
    y = to.y + pad;
  }
}

}  // namespace limpid
