#include "app/desktop/panels/unsaved_question.h"

#include <imgui.h>

#include "app/desktop/widgets/modal.h"

namespace limpid {

Action draw_unsaved_question(bool& open, bool has_file) {
  Action answer = Action::none;
  if (!begin_modal("Save changes?", open, {0, 0})) return answer;
  ImGui::PushTextWrapPos(28 * ImGui::GetFontSize());
  ImGui::TextUnformatted("The scene has changes that are not saved.");
  ImGui::PopTextWrapPos();
  ImGui::Spacing();
  if (ImGui::Button(has_file ? "Save (Enter)" : "Save as... (Enter)")) {
    answer = Action::save_and_leave;
  }
  ImGui::SameLine();
  if (ImGui::Button("Discard (D)")) answer = Action::discard_and_leave;
  ImGui::SameLine();
  close_button("Cancel (Esc)", open);
  ImGui::EndPopup();
  return answer;
}

}  // namespace limpid
