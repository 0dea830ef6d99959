#include "app/desktop/shell/person_question.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "app/desktop/widgets/modal.h"
#include "app/style/imgui_input.h"

namespace limpid {
namespace {

constexpr double kStays = 0.3;  // time that it stays after an answer [s]
constexpr float kLargeText = 1.3f;
// Titles of both windows; ImGui knows them as the same window by the text behind ###.
constexpr const char* kModalTitle = "A question###question";
constexpr const char* kMessageTitle = "A message###question";

}  // namespace

void PersonQuestion::ask(std::string text, std::vector<std::string> choices, How how) {
  asks_ = true;
  ++number_;
  text_ = std::move(text);
  choices_ = std::move(choices);
  how_ = how;
  shown_.reset();
  answered_.reset();
  taken_.reset();
  answer_.reset();
}

void PersonQuestion::withdraw() {
  asks_ = false;
  answered_.reset();
}

const char* PersonQuestion::title() const {
  if (how_.beside) return "A question beside the picture";
  return choices_.size() > 1 ? kModalTitle : kMessageTitle;
}

double PersonQuestion::seconds_since(Clock::time_point time) const {
  return std::chrono::duration<double>(Clock::now() - time).count();
}

// Returns the choice of a key. Keys pressed before the question was seen do not count.
std::optional<std::size_t> PersonQuestion::chosen() const {
  if (!shown_ || ImGui::IsWindowAppearing()) return std::nullopt;
  const ImGuiIO& io = ImGui::GetIO();
  for (const ImWchar c : io.InputQueueCharacters) {
    const auto digit = static_cast<std::size_t>(c - '1');
    if (c >= '1' && digit < choices_.size()) return digit;
  }
  // Modifiers do not count for digits: a French keyboard writes them with Shift, a keypad with its
  // lock.
  const bool bare = !io.KeyCtrl && !io.KeyShift && !io.KeyAlt;
  for (std::size_t i = 0; bare && i < choices_.size(); ++i) {
    const int digit = static_cast<int>(i);
    if (key_pressed(GLFW_KEY_1 + digit, false) || key_pressed(GLFW_KEY_KP_1 + digit, false)) {
      return i;
    }
  }
  if (choices_.size() != 1) return std::nullopt;
  // A click into the picture takes ImGui's focus from a question beside it, but not the keys.
  const bool enter =
      how_.beside ? key_pressed(GLFW_KEY_ENTER, false) || key_pressed(GLFW_KEY_KP_ENTER, false)
                  : accepted();
  return enter ? std::optional<std::size_t>(0) : std::nullopt;
}

// Begins its window. It has no cross, and Esc is no answer: the program opens it again.
bool PersonQuestion::begin(bool& open, ScreenRect view) const {
  if (!how_.beside) return begin_modal(title(), open, {0, 0}, false);
  // An earlier modal question has to be closed by ImGui, too.
  bool before = false;
  begin_modal(kModalTitle, before, {0, 0});
  if (!open) return false;
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.5f * (view.min.x + view.max.x), view.max.y - em}, ImGuiCond_Always,
                          {0.5f, 1});
  ImGui::SetNextWindowBgAlpha(0.92f);
  ImGui::Begin(title(), nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  return true;
}

// Returns the choice of the mouse. Beside the picture choices stand in lines of the width `room`.
std::optional<std::size_t> PersonQuestion::draw_choices(float room) const {
  std::optional<std::size_t> chosen;
  const float em = ImGui::GetFontSize();
  float line = 0;
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    const std::string label = choices_.size() == 1 ? choices_[i] + "  (Enter)"
                                                   : fmt::format("{}   {}", i + 1, choices_[i]);
    const ImGuiStyle& style = ImGui::GetStyle();
    const float needed = ImGui::CalcTextSize(label.c_str()).x + 2 * style.FramePadding.x;
    const float wide = std::max(how_.beside ? 10 * em : 14 * em, needed);
    if (how_.beside && i > 0 && line + style.ItemSpacing.x + wide < room) {
      ImGui::SameLine();
      line += style.ItemSpacing.x + wide;
    } else {
      line = wide;
    }
    const bool taken = taken_ == i;
    if (taken) {
      ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    }
    if (ImGui::Button(label.c_str(), {wide, 0})) chosen = i;
    if (taken) ImGui::PopStyleColor();
    note_place(choices_[i].c_str());
  }
  return chosen;
}

// Draws the time left as a bar.
void PersonQuestion::draw_time() const {
  if (how_.seconds <= 0) return;
  const double gone = !shown_ ? 0 : asks_ ? seconds_since(*shown_) : how_.seconds;
  const auto left = static_cast<float>(std::clamp(1 - gone / how_.seconds, 0.0, 1.0));
  const float em = ImGui::GetFontSize();
  ImGui::ProgressBar(left, {std::max(14 * em, ImGui::GetItemRectSize().x), 0.3f * em}, "");
}

void PersonQuestion::end_with(std::optional<std::size_t> choice) {
  answer_ = Answer{choice, seconds_since(*shown_)};
  answered_ = Clock::now();
  taken_ = choice;
  asks_ = false;
}

void PersonQuestion::draw(bool& open, ScreenRect view) {
  const bool stays = how_.beside && answered_ && seconds_since(*answered_) < kStays;
  if (!asks_ && !stays) open = false;
  if (!begin(open, view)) return;
  std::optional<std::size_t> choice = chosen();
  ImGui::SetWindowFontScale(kLargeText);  // a participant may sit far from the screen
  ImGui::PushTextWrapPos(26 * ImGui::GetFontSize());
  ImGui::TextUnformatted(text_.c_str());
  ImGui::PopTextWrapPos();
  ImGui::SetWindowFontScale(1);
  draw_time();
  if (!choices_.empty()) ImGui::Spacing();
  if (const auto clicked = draw_choices(view.width() - 3 * ImGui::GetFontSize())) choice = clicked;
  if (how_.beside) {
    ImGui::End();
  } else {
    ImGui::EndPopup();
  }
  if (!asks_) return;
  if (!shown_) shown_ = Clock::now();
  const bool over = how_.seconds > 0 && seconds_since(*shown_) >= how_.seconds;
  if (!choice && !over) return;
  end_with(choice);
  if (!how_.beside) open = false;
}

}  // namespace limpid
