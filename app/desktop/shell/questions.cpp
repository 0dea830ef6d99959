#include "app/desktop/shell/questions.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "app/desktop/widgets/modal.h"
#include "app/style/imgui_input.h"

namespace limpid {

void draw_unsaved_question(bool& open, bool has_file, const Act& act) {
  if (!begin_modal("Save changes?", open, {0, 0})) return;
  const char* answer = nullptr;
  ImGui::PushTextWrapPos(28 * ImGui::GetFontSize());
  ImGui::TextUnformatted("The scene has changes that are not saved.");
  ImGui::PopTextWrapPos();
  ImGui::Spacing();
  if (ImGui::Button(has_file ? "Save (Enter)" : "Save as... (Enter)")) {
    answer = "scene.save_and_leave";
  }
  ImGui::SameLine();
  if (ImGui::Button("Discard (D)")) answer = "scene.discard_and_leave";
  ImGui::SameLine();
  close_button("Cancel (Esc)", open);
  ImGui::EndPopup();
  if (answer != nullptr) act(answer);  // may throw
}

void draw_quit_question(bool& open, const Act& act) {
  if (!begin_modal("End the recording?", open, {0, 0})) return;
  ImGui::PushTextWrapPos(28 * ImGui::GetFontSize());
  ImGui::TextUnformatted("A recording is running. The part recorded until now is kept.");
  ImGui::PopTextWrapPos();
  ImGui::Spacing();
  bool end = accepted();
  end = ImGui::Button("End it and quit (Enter)") || end;
  ImGui::SameLine();
  close_button("Go on (Esc)", open);
  ImGui::EndPopup();
  if (!end) return;
  open = false;
  act("window.end_recording_and_quit");
}

// Enter is no answer here: the question is to be read.
bool draw_xacro_question(bool& open, const std::filesystem::path& file) {
  if (!begin_modal("Expand xacro?", open, {0, 0})) return false;
  ImGui::PushTextWrapPos(28 * ImGui::GetFontSize());
  ImGui::TextWrapped(
      "%s is a xacro file. To expand it, Limpid runs the program xacro, which can run code from "
      "the file.",
      file.filename().c_str());
  ImGui::PopTextWrapPos();
  ImGui::Spacing();
  const bool expand = ImGui::Button("Expand");
  if (expand) open = false;
  ImGui::SameLine();
  close_button("Cancel (Esc)", open);
  ImGui::EndPopup();
  return expand;
}

std::string TipQuestion::draw(bool& open, const TipsToChoose& choice) {
  const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
  const float em = ImGui::GetFontSize();
  if (!begin_modal("Tip of the arm", open, {std::min(30 * em, 0.94f * room.x), 0})) {
    was_open_ = false;
    return {};
  }
  const bool appears = !was_open_;
  was_open_ = true;
  if (appears) chosen_ = 0;
  ImGui::TextWrapped(
      "%s has more than one end. Which end does the hand hold? The other branches do not move.",
      std::filesystem::path(choice.file).filename().c_str());
  const std::size_t before = chosen_;
  if (key_pressed(GLFW_KEY_DOWN) && chosen_ + 1 < choice.tips.size()) ++chosen_;
  if (key_pressed(GLFW_KEY_UP) && chosen_ > 0) --chosen_;
  bool taken = accepted();
  ImGui::BeginChild("tips", {0, std::min(12 * em, 0.45f * room.y)}, true);
  for (std::size_t i = 0; i < choice.tips.size(); ++i) {
    const ArmTip& tip = choice.tips[i];
    const std::string text =
        fmt::format("{}   {} joint{}", tip.link, tip.joints, tip.joints == 1 ? "" : "s");
    if (ImGui::Selectable(text.c_str(), i == chosen_, ImGuiSelectableFlags_AllowDoubleClick)) {
      chosen_ = i;
      taken = taken || ImGui::IsMouseDoubleClicked(0);
    }
    if (i == chosen_ && (appears || chosen_ != before)) ImGui::SetScrollHereY();
  }
  ImGui::EndChild();
  taken = ImGui::Button("Open (Enter)") || taken;
  ImGui::SameLine();
  close_button("Cancel (Esc)", open);
  ImGui::EndPopup();
  if (!taken || chosen_ >= choice.tips.size()) return {};
  open = false;
  return choice.tips[chosen_].link;
}

}  // namespace limpid
