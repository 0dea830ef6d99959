#include "app/desktop/panels/xacro_question.h"

#include <imgui.h>

#include "app/desktop/widgets/modal.h"

namespace limpid {

// Enter does not answer it: what it asks is to be read.
bool draw_xacro_question(bool& open, const std::filesystem::path& file) {
  if (!begin_modal("Expand xacro?", open, {0, 0})) return false;
  ImGui::PushTextWrapPos(28 * ImGui::GetFontSize());
  ImGui::TextWrapped(
      "%s is a xacro file: expanding it runs program xacro, which can run code in "
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

}  // namespace limpid
