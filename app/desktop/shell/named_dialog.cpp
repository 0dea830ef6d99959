#include "app/desktop/shell/named_dialog.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <utility>

#include "app/desktop/widgets/modal.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {

NamedDialog::Asked NamedDialog::draw(bool& open, NamedTexts& texts) {
  const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
  const float em = ImGui::GetFontSize();
  if (!begin_modal(options_.title, open, {std::min(30 * em, 0.94f * room.x), 0})) {
    was_open_ = false;
    return {};
  }
  const bool appears = !was_open_;
  was_open_ = true;
  if (appears) choose("");
  ImGui::TextWrapped("%s", options_.help);
  ImGui::BeginChild("names", {0, std::min(12 * em, 0.45f * room.y)}, true);
  Asked asked = draw_list(texts);
  ImGui::EndChild();
  if (const Asked pressed = draw_buttons(texts); pressed.request != Request::none) asked = pressed;
  ImGui::Separator();
  ImGui::SetNextItemWidth(-13 * em);
  if (appears) ImGui::SetKeyboardFocusHere();
  const std::string before = name_;
  const bool entered = ImGui::InputTextWithHint("##name", "a name; Enter uses or saves it", &name_,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  if (name_ != before) {
    complaint_.clear();
    sure_ = false;
    if (texts.find(name_) != nullptr) chosen_ = name_;
  }
  if (entered) ImGui::SetKeyboardFocusHere(-1);
  ImGui::SameLine();
  if (const Asked kept = draw_name(texts, entered); kept.request != Request::none) asked = kept;
  if (!complaint_.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(current_palette().broken));
    ImGui::TextWrapped("%s", complaint_.c_str());
    ImGui::PopStyleColor();
  }
  close_button("Close (Esc)", open);
  if (asked.request == Request::use) open = false;
  ImGui::EndPopup();
  return asked;
}

NamedDialog::Asked NamedDialog::draw_list(const NamedTexts& texts) {
  Asked asked;
  for (const NamedTexts::Entry& entry : texts.all()) {
    const std::string chosen = chosen_;
    ImGui::PushID(entry.name.c_str());
    if (ImGui::Selectable(entry.name.c_str(), chosen == entry.name,
                          ImGuiSelectableFlags_AllowDoubleClick)) {
      choose(entry.name);
      if (ImGui::IsMouseDoubleClicked(0)) asked = {Request::use, entry.name};
    }
    if (entry.shipped) {
      const char* text = "comes with Limpid";
      ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text).x);
      ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(current_palette().muted));
      ImGui::TextUnformatted(text);
      ImGui::PopStyleColor();
    }
    ImGui::PopID();
  }
  return asked;
}

NamedDialog::Asked NamedDialog::draw_buttons(NamedTexts& texts) {
  Asked asked;
  ImGui::BeginDisabled(chosen_.empty());
  if (ImGui::Button("Use")) asked = {Request::use, chosen_};
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(chosen_.empty() || !texts.may_change(chosen_));
  draw_changes(texts);
  ImGui::EndDisabled();
  return asked;
}

void NamedDialog::draw_changes(NamedTexts& texts) {
  if (noted_button("Rename")) {
    if (name_.empty() || name_ == chosen_) {
      complaint_ = "Write the new name below first.";
    } else if (texts.find(name_) != nullptr) {
      complaint_ = fmt::format("There is a {} called {} already.", options_.what, name_);
    } else {
      complaint_ = texts.rename(chosen_, name_);
      if (complaint_.empty()) chosen_ = name_;
    }
  }
  ImGui::SameLine();
  if (!noted_button(sure_ ? "Remove it" : "Remove")) return;
  if (!std::exchange(sure_, true)) return;
  const std::string wrong = texts.remove(chosen_);
  choose("");
  complaint_ = wrong;
}

// Offers to save the present state under the typed name; Enter uses an existing text of that name.
NamedDialog::Asked NamedDialog::draw_name(const NamedTexts& texts, bool entered) {
  const bool known = texts.find(name_) != nullptr;
  const bool replaces = known && texts.may_change(name_);
  const bool pressed =
      ImGui::Button(replaces ? "Replace by the present one" : "Save the present one");
  if (!pressed && !entered) return {};
  if (!pressed && known) return {Request::use, name_};
  if (name_.empty()) {
    complaint_ = "Type a name first.";
  } else if (known && !replaces) {
    complaint_ = fmt::format("{} comes with Limpid; choose another name.", name_);
  } else {
    chosen_ = name_;
    return {Request::keep, name_};
  }
  return {};
}

void NamedDialog::choose(const std::string& name) {
  chosen_ = name_ = name;
  complaint_.clear();
  sure_ = false;
}

}  // namespace limpid
