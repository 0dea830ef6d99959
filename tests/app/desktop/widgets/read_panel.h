// A panel drawn by itself, frame by frame: what it says, its tooltips, its buttons and fields.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <string>

#include "app/style/theme.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/drawn_text.h"

namespace limpid {

// Letters that ImGui's own font does not have are read as '?'.
class ReadPanel : public ImGuiFrames {
 protected:
  static constexpr float kWidth = 400, kHeight = 1400;

  ReadPanel() {
    ImGui::GetIO().DisplaySize = {1600, kHeight};
    apply_theme(Theme::dark, 1);
  }

  // Draws the panel from now on.
  void show(std::function<void()> draw) {
    draw_ = std::move(draw);
    away();
  }
  void frames(int count = 3) {
    for (int i = 0; i < count; ++i) {
      frame([&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({kWidth, kHeight});
        ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoTitleBar);
        const auto& context = *ImGui::GetCurrentContext();
        const int styles = context.StyleVarStack.Size, colours = context.ColorStack.Size;
        const int windows = context.CurrentWindowStack.Size;
        draw_();
        EXPECT_EQ(context.StyleVarStack.Size, styles) << "a style is left";
        EXPECT_EQ(context.ColorStack.Size, colours) << "a colour is left";
        EXPECT_EQ(context.CurrentWindowStack.Size, windows) << "a window is left open";
        ImGui::End();
      });
    }
  }
  void away() {
    show_mouse({1599, kHeight - 1});
    frames();
  }

  // Finds a text; `part`: in a part of the panel with such a name.
  static std::optional<test::DrawnText> find(const std::string& text,
                                             const std::string& part = "") {
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.text == text && !each.window.starts_with("##Tooltip") &&
          each.window.find(part) != std::string::npos) {
        return each;
      }
    }
    return std::nullopt;
  }
  // All that the panel says, a text a line.
  static std::string words() {
    std::string all;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (!each.window.starts_with("##Tooltip")) all += each.text + '\n';
    }
    return all;
  }
  // The same in one line, as a sentence may stand in several.
  static std::string sentences() {
    std::string all = words();
    std::ranges::replace(all, '\n', ' ');
    return all;
  }
  // The text at the right of a label, in its line.
  static std::optional<test::DrawnText> beside(const std::string& label) {
    const auto at = find(label);
    std::optional<test::DrawnText> last;
    for (const test::DrawnText& each : test::drawn_texts()) {
      const bool in_line = at && each.window == at->window && each.min.x > at->max.x &&
                           each.middle().y > at->min.y - 3 && each.middle().y < at->max.y + 3;
      if (in_line && (!last || each.min.x > last->min.x)) last = each;
    }
    EXPECT_TRUE(last) << label << " has no value in:\n" << words();
    return last;
  }
  static std::string value(const std::string& label) {
    const auto text = beside(label);
    return text ? text->text : "";
  }
  // Tells whether a label's value is drawn in the colour of broken promises.
  static bool broken(const std::string& label) {
    const auto text = beside(label);
    return text && text->colour == colour(current_palette().broken);
  }
  // Returns what the tooltip says while the mouse is over a text; empty for none.
  std::string hint(const std::string& text, const std::string& part = "") {
    const auto at = find(text, part);
    EXPECT_TRUE(at) << text << " is not in:\n" << words();
    if (!at) return "";
    show_mouse(at->middle());
    frames();
    std::string said;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window.starts_with("##Tooltip")) said += (said.empty() ? "" : " ") + each.text;
    }
    away();
    return said;
  }
  void click(ImVec2 at) {
    show_mouse(at);
    frames(2);
    for (const bool down : {true, false}) {
      show_mouse_button(0, down);
      frames(1);
    }
    away();
  }
  void click(const std::string& text, const std::string& part = "") {
    const auto at = find(text, part);
    ASSERT_TRUE(at) << text << " is not in:\n" << words();
    click(at->middle());
  }
  // Types a number in place of that of a field, with a double click and Enter.
  void type(ImVec2 at, const std::string& text) {
    show_mouse(at);
    frames(20);  // clicks before are over
    for (int i = 0; i < 2; ++i) {
      for (const bool down : {true, false}) {
        show_mouse_button(0, down);
        frames(1);
      }
    }
    frames(2);
    ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
    frames(2);
    for (const bool down : {true, false}) {
      show_key(GLFW_KEY_ENTER, down);
      frames(1);
    }
    away();
  }

 private:
  std::function<void()> draw_ = [] {};
};

}  // namespace limpid
