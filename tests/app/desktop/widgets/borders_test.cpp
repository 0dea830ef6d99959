// Borders between panels and tabs that fold them, lists by arrow keys, bars and values.
#include <imgui_internal.h>

#include <cmath>
#include <map>
#include <utility>

#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "tests/app/desktop/widgets/read_panel.h"
#include "tests/support/drawn_ink.h"

namespace limpid {
namespace {

class Borders : public ReadPanel {
 protected:
  // Drags from a place by `by`.
  void drag(ImVec2 from, ImVec2 by) {
    show_mouse(from);
    frames(2);
    show_mouse_button(0, true);
    frames(2);
    show_mouse({from.x + by.x, from.y + by.y});
    frames(2);
    show_mouse_button(0, false);
    frames(1);
    away();
  }
  static bool has_ink(ImVec2 at, Rgb ink) {
    const ImU32 wanted = colour(ink) & 0x00ffffff;
    return test::inked(at, [&](ImU32 each) { return (each & 0x00ffffff) == wanted; });
  }
  void press(int key) {
    for (const bool down : {true, false}) {
      show_key(key, down);
      frames(1);
    }
  }
};

TEST_F(Borders, FoldByTheirTab) {
  bool wanted = true;
  const ScreenRect rect{{700, 100}, {712, 144}};
  show([&] {
    ImGui::End();
    fold_tab("tab", rect, wanted ? ImGuiDir_Left : ImGuiDir_Right, "Hides the panel", wanted);
    ImGui::Begin("panel");
  });
  const ImGuiWindow* window = ImGui::FindWindowByName("tab");
  ASSERT_NE(window, nullptr);
  EXPECT_EQ(window->Pos.x, rect.min.x);
  EXPECT_EQ(window->Pos.y, rect.min.y);
  EXPECT_EQ(window->Size.x, rect.width());
  EXPECT_EQ(window->Size.y, rect.height());
  const Palette& colours = current_palette();
  EXPECT_TRUE(has_ink({703, 110}, colours.frame));
  const auto arrow = [](Rgb ink) {
    bool there = false;
    for (float x = 703; x < 711; x += 0.5f) there = there || has_ink({x, 122}, ink);
    return there;
  };
  EXPECT_TRUE(arrow(colours.muted));
  show_mouse({703, 110});
  frames(4);
  EXPECT_TRUE(has_ink({703, 110}, colours.frame_active));
  EXPECT_TRUE(arrow(colours.text));
  std::string said;
  for (const test::DrawnText& each : test::drawn_texts()) {
    if (each.window.starts_with("##Tooltip")) said += each.text;
  }
  EXPECT_EQ(said, "Hides the panel");
  click(ImVec2{706, 122});
  EXPECT_FALSE(wanted);
  click(ImVec2{710, 142});
  EXPECT_TRUE(wanted);
  click(ImVec2{716, 122});
  EXPECT_TRUE(wanted) << "beside it";
}

TEST_F(Borders, OfAListAreKeptByArrowKeys) {
  ListKeys keys;
  int count = 7, columns = 1, taken = -1;
  show([&] {
    keys.move(count, columns);
    for (int i = 0; i < count; ++i) {
      ImGui::Text("item %d%s", i, keys.at(i) ? " marked" : "");
      if (keys.taken(i)) taken = i;
    }
  });
  const auto at = [&] {
    for (int i = 0; i < count; ++i) {
      if (find("item " + std::to_string(i) + " marked")) return i;
    }
    return -1;
  };
  EXPECT_EQ(at(), -1);
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(taken, -1) << "none is chosen";
  const auto goes = [&](int key, int to) {
    press(key);
    frames(1);
    EXPECT_EQ(at(), to) << key;
  };
  goes(GLFW_KEY_DOWN, 0);
  goes(GLFW_KEY_DOWN, 1);
  goes(GLFW_KEY_RIGHT, 1);
  goes(GLFW_KEY_LEFT, 1);
  goes(GLFW_KEY_UP, 0);
  goes(GLFW_KEY_UP, 0);
  columns = 3;
  goes(GLFW_KEY_DOWN, 3);
  goes(GLFW_KEY_RIGHT, 4);
  goes(GLFW_KEY_LEFT, 3);
  goes(GLFW_KEY_DOWN, 6);
  goes(GLFW_KEY_RIGHT, 6);
  goes(GLFW_KEY_UP, 3);
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(std::exchange(taken, -1), 3);
  press(GLFW_KEY_KP_ENTER);
  EXPECT_EQ(std::exchange(taken, -1), 3);
  count = 2;
  goes(GLFW_KEY_UP, 0);
  count = 0;
  frames(1);
  count = 5;
  frames(1);
  EXPECT_EQ(at(), -1) << "the list was empty";
  goes(GLFW_KEY_DOWN, 0);
  keys.forget();
  frames(1);
  EXPECT_EQ(at(), -1);
}

TEST_F(Borders, OfABarAreAtItsPart) {
  double part = 0.25;
  std::string text;
  show([&] { progress_bar(part, 200, text); });
  const Palette& colours = current_palette();
  const float left = ImGui::GetStyle().WindowPadding.x;
  const auto right_of_edge = find("25 %");
  ASSERT_TRUE(right_of_edge);
  EXPECT_NEAR(right_of_edge->middle().x, left + 100, 2);
  EXPECT_NEAR(right_of_edge->clip.x, left + 50, 1);
  EXPECT_EQ(right_of_edge->colour, colour(colours.text));
  part = 0.75;
  frames(2);
  const auto left_of_edge = find("75 %");
  ASSERT_TRUE(left_of_edge);
  EXPECT_NEAR(left_of_edge->clip.z, left + 150, 1);
  EXPECT_EQ(left_of_edge->colour, colour(colours.panel));
  part = 1.5;
  frames(2);
  EXPECT_TRUE(find("100 %"));
  part = -1;
  frames(2);
  EXPECT_TRUE(find("0 %"));
  text = "3 of 12";
  frames(2);
  EXPECT_THAT(words(), testing::HasSubstr("3 of 12"));
  EXPECT_THAT(words(), testing::Not(testing::HasSubstr("%")));
}

TEST_F(Borders, LeaveAValueBesideItsLabelOrBelowIt) {
  std::string value = "12.5 N", broken;
  show([&] { read_out("force", value, broken, "of the motors"); });
  EXPECT_EQ(this->value("force"), "12.5 N");
  EXPECT_NEAR(find("12.5 N")->max.x, kWidth - ImGui::GetStyle().WindowPadding.x, 2);
  EXPECT_EQ(find("force")->colour, colour(current_palette().muted));
  EXPECT_FALSE(ReadPanel::broken("force"));
  EXPECT_EQ(hint("force"), "of the motors");
  EXPECT_EQ(hint("12.5 N"), "of the motors");
  broken = "It is too much.";
  frames(2);
  EXPECT_TRUE(ReadPanel::broken("force"));
  EXPECT_EQ(hint("12.5 N"), "It is too much.");
  value = std::string(52, 'x');
  frames(2);
  const auto label = find("force"), below = find(value);
  ASSERT_TRUE(label && below) << words();
  EXPECT_GT(below->min.y, label->max.y);
}

TEST_F(Borders, GoOnInTheLineWhileThereIsRoom) {
  show([] {
    ImGui::TextUnformatted("first");
    for (int i = 0; i < 9; ++i) {
      flow(100.f);
      ImGui::SetNextItemWidth(100);
      ImGui::Button(("b" + std::to_string(i)).c_str(), {100, 0});
    }
  });
  std::map<int, int> lines;  // buttons of each line
  for (const test::DrawnText& each : test::drawn_texts()) {
    if (each.text.starts_with("b")) ++lines[static_cast<int>(std::lround(each.min.y / 5))];
    EXPECT_LT(each.max.x, kWidth);
  }
  const ImGuiStyle& style = ImGui::GetStyle();
  const float gap = style.ItemSpacing.x, room = kWidth - 2 * style.WindowPadding.x;
  const int each_line = static_cast<int>((room + gap) / (100 + gap));
  const int first_line = static_cast<int>((room - ImGui::CalcTextSize("first").x) / (100 + gap));
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.begin()->second, first_line);
  int left = 9 - first_line;
  for (auto line = std::next(lines.begin()); line != lines.end(); ++line) {
    EXPECT_EQ(line->second, std::min(left, each_line));
    left -= line->second;
  }
  EXPECT_EQ(left, 0);
}

TEST(SmallLetters, FindPartsInAnyLetters) {
  EXPECT_EQ(small_letters("aB9-Z"), "ab9-z");
  EXPECT_TRUE(has_part("Dominoes.toml", "INO"));
  EXPECT_TRUE(has_part("DOMINOES", "noes"));
  EXPECT_TRUE(has_part("x", ""));
  EXPECT_FALSE(has_part("ino", "dominoes"));
}

}  // namespace
}  // namespace limpid
