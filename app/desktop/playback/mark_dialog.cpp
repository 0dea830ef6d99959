#include "app/desktop/playback/mark_dialog.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "app/desktop/widgets/modal.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "devices/files/session/session.h"

namespace limpid {

MarkAnswer MarkDialog::draw(bool& open, const std::string& when, const std::string& text,
                            bool there) {
  const float em = ImGui::GetFontSize();
  const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
  if (!begin_modal("Mark", open, {std::min(26 * em, 0.94f * room.x), 0})) {
    was_open_ = false;
    return {};
  }
  if (!was_open_) {
    text_ = text;
    ImGui::SetKeyboardFocusHere();
  }
  was_open_ = true;
  MarkAnswer answer;
  ImGui::SetNextItemWidth(-1);
  const bool entered = ImGui::InputTextWithHint(
      "##text", "a note about this moment", &text_,
      ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  const bool too_long = text_.size() > kMarkLength;
  ImGui::PushStyleColor(
      ImGuiCol_Text, colour_vector(too_long ? current_palette().broken : current_palette().muted));
  if (too_long) {
    ImGui::Text("%zu bytes; allowed: at most %zu", text_.size(), kMarkLength);
  } else {
    ImGui::TextUnformatted(when.c_str());
  }
  ImGui::PopStyleColor();
  const bool good = !text_.empty() && !too_long;
  ImGui::BeginDisabled(!good);
  const bool pressed = noted_button(there ? "Rename (Enter)" : "Set (Enter)");
  ImGui::EndDisabled();
  if (good && (pressed || entered)) {
    answer.text = text_;
    open = false;
  }
  ImGui::SameLine();
  if (there && noted_button("Remove")) {
    answer.remove = true;
    open = false;
  }
  if (there) ImGui::SameLine();
  close_button("Cancel (Esc)", open);
  ImGui::EndPopup();
  return answer;
}

}  // namespace limpid
