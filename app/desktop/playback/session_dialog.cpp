#include "app/desktop/playback/session_dialog.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "app/base/folders.h"
#include "app/desktop/base/settings.h"
#include "app/desktop/base/thumbnails.h"
#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/path_dialog.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {

namespace fs = std::filesystem;

// Draws the recordings of a folder, newest names first; returns the one that was clicked. What is
// typed, unless it is a path, is a part of their names.
fs::path SessionDialog::list(const char* name, const fs::path& folder) {
  heading(name);
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const bool meant =
        typed_.find('/') != std::string::npos || has_part(entry.path().filename().string(), typed_);
    if (entry.path().extension() == ".h5" && meant) files.push_back(entry.path());
  }
  std::ranges::sort(files, std::greater{});
  if (files.empty())
    ImGui::TextDisabled("%s", typed_.empty() ? "none yet" : "no recording of this name");
  if (first_.empty() && !files.empty()) first_ = files.front();
  fs::path chosen;
  for (const fs::path& file : files) {
    const double mib = static_cast<double>(fs::file_size(file, none)) / (1 << 20);
    const int item = listed_++;
    if (picture_item({.picture = pictures_.get(picture_of(file)),
                      .name = file.filename().string(),
                      .about = fmt::format("{:.1f} MiB", mib)},
                     0, keys_.at(item)) ||
        keys_.taken(item)) {
      chosen = file;
    }
  }
  return chosen;
}

fs::path SessionDialog::draw(bool& open, bool& elsewhere) {
  const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
  const float em = ImGui::GetFontSize();
  const bool shown = begin_modal("Open session", open, {std::min(34 * em, 0.94f * room.x), 0});
  if (!shown) {
    was_shown_ = false;
    return {};
  }
  if (!was_shown_) {
    typed_ = complaint_ = "";
    pictures_.clear();
    keys_.forget();
  }
  ImGui::SetNextItemWidth(-1);
  if (!was_shown_) ImGui::SetKeyboardFocusHere();
  was_shown_ = true;
  fs::path chosen;
  bool entered = false;
  const std::string before = typed_;
  if (ImGui::InputTextWithHint("##path", "a part of a name, a path, or a sweep's folder", &typed_,
                               ImGuiInputTextFlags_EnterReturnsTrue) ||
      accepted()) {
    entered = true;
  }
  if (typed_ != before) {
    complaint_.clear();
    keys_.forget();
  }
  if (!complaint_.empty()) {
    ImGui::TextColored(colour_vector(current_palette().broken), "%s", complaint_.c_str());
  }
  keys_.move(std::exchange(listed_, 0));
  first_.clear();
  ImGui::BeginChild("sessions", {0, std::min(20 * em, 0.55f * room.y)});
  for (const auto& [name, dir] : {std::pair{"Yours", sessions_dir()},
                                  {"Shipped with Limpid", data_dir() / "assets/sessions"}}) {
    if (const fs::path clicked = list(name, dir); !clicked.empty()) chosen = clicked;
  }
  ImGui::EndChild();
  entered = ImGui::Button("Open (Enter)") || entered;
  if (entered && chosen.empty() && !typed_.empty()) {
    const bool part = typed_.find('/') == std::string::npos && !first_.empty();
    chosen = part ? first_ : expanded(typed_);
  }
  ImGui::SameLine();
  close_button("Cancel (Esc)", open);
  ImGui::SameLine();
  elsewhere = noted_button("Elsewhere...");
  if (elsewhere) open = false;
  ImGui::EndPopup();
  std::error_code none;
  if (chosen.empty() || elsewhere) return {};
  if (!fs::is_regular_file(chosen, none) && !fs::is_regular_file(chosen / "table.h5", none)) {
    complaint_ = fs::is_directory(chosen, none) ? "There is no table.h5 of a sweep in that folder."
                                                : "There is no such file.";
    return {};
  }
  open = false;
  return chosen;
}

}  // namespace limpid
