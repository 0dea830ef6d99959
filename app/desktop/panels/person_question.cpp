#include "app/desktop/panels/person_question.h"

#include <fmt/format.h>
#include <imgui.h>

#include <utility>

#include "app/desktop/widgets/modal.h"

namespace limpid {

void PersonQuestion::ask(std::string text, std::vector<std::string> choices) {
  text_ = std::move(text);
  choices_ = std::move(choices);
  shown_.reset();
  answer_.reset();
}

// By a key; what was pressed before the question was seen is no answer to it.
std::optional<std::size_t> PersonQuestion::chosen() const {
  if (!shown_ || ImGui::IsWindowAppearing()) return std::nullopt;
  for (const ImWchar c : ImGui::GetIO().InputQueueCharacters) {
    const auto digit = static_cast<std::size_t>(c - '1');
    if (c >= '1' && digit < choices_.size()) return digit;
  }
  if (choices_.size() == 1 && accepted()) return 0;
  return std::nullopt;
}

// Its cross and Esc are no answer: whoever asks opens it again.
void PersonQuestion::draw(bool& open) {
  if (!asking()) open = false;
  if (!begin_modal(kTitle, open, {0, 0})) return;
  std::optional<std::size_t> choice = chosen();
  ImGui::PushTextWrapPos(34 * ImGui::GetFontSize());
  ImGui::TextUnformatted(text_.c_str());
  ImGui::PopTextWrapPos();
  ImGui::Spacing();
  const float wide = 14 * ImGui::GetFontSize();
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    const std::string label = choices_.size() == 1 ? choices_[i] + "  (Enter)"
                                                   : fmt::format("{}   {}", i + 1, choices_[i]);
    if (ImGui::Button(label.c_str(), {wide, 0})) choice = i;
    note_place(choices_[i].c_str());
  }
  ImGui::EndPopup();
  const auto now = Clock::now();
  if (!shown_) shown_ = now;
  if (!choice) return;
  answer_ = Answer{*choice, std::chrono::duration<double>(now - *shown_).count()};
  text_.clear();
  open = false;
}

}  // namespace limpid
