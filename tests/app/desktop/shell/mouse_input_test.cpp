#include "app/desktop/shell/input.h"
#include "tests/app/plot/imgui_frames.h"

namespace limpid {
namespace {

class MouseInputTest : public ImGuiFrames {
 protected:
  // Asks GLFW at this time [ms].
  void ask(int at) { mouse_.ask(SteadyClock::time_point(std::chrono::milliseconds(1000 + at))); }
  void move(float x, float y) {
    mouse_.move(x, y);
    now_ = {x, y};
  }
  void click(float x, float y) {
    move(x, y);
    mouse_.button(0, true);
    mouse_.button(0, false);
  }
  void look() {
    mouse_.deal(now_);
    frame([] {}, 0.5f);
  }
  // ImGui's count of clicks at the next press; 0 without one.
  int next_count() {
    while (mouse_.waiting()) {
      look();
      if (ImGui::GetIO().MouseClicked[0]) return ImGui::GetIO().MouseClickedCount[0];
    }
    return 0;
  }

  MouseInput mouse_;
  ImVec2 now_{0, 0};
};

TEST_F(MouseInputTest, ClicksBetweenTwoFramesAreAllSeenAndWhereTheyWere) {
  ask(0);
  click(100, 50);
  click(300, 200);
  move(700, 500);
  for (const ImVec2 at : {ImVec2(100, 50), ImVec2(300, 200)}) {
    look();
    EXPECT_TRUE(ImGui::IsMouseClicked(0));
    EXPECT_EQ(ImGui::GetMousePos().x, at.x);
    EXPECT_EQ(ImGui::GetMousePos().y, at.y);
    look();
    EXPECT_TRUE(ImGui::IsMouseReleased(0));
    EXPECT_EQ(ImGui::GetMousePos().x, at.x);
  }
  EXPECT_FALSE(mouse_.waiting());
}

TEST_F(MouseInputTest, DoubleClickIsOneOnFramesOfHalfASecond) {
  ask(0), ask(500);
  click(100, 50);
  click(100, 50);
  EXPECT_EQ(next_count(), 1);
  EXPECT_EQ(next_count(), 2);
}

TEST_F(MouseInputTest, DoubleClickIsOneWithAFrameBetween) {
  ask(0), ask(500);
  click(100, 50);
  EXPECT_EQ(next_count(), 1);
  ask(1000);
  click(100, 50);
  EXPECT_EQ(next_count(), 2);
}

TEST_F(MouseInputTest, TwoClicksAreNoneHoweverLateTheyAreSeen) {
  ask(0), ask(500);
  click(100, 50);
  for (const int at : {600, 700, 800, 900, 1000}) ask(at);
  click(100, 50);
  EXPECT_EQ(next_count(), 1);
  EXPECT_EQ(next_count(), 1);
}

TEST_F(MouseInputTest, ASecondPressThatIsComingIsWaitedFor) {
  ask(0), ask(500);
  click(100, 50);
  click(100, 50);
  look();
  look();  // the release; the second press comes with the next frame
  EXPECT_GT(ImGui::GetIO().MouseDoubleClickTime, 10.0f);
  while (mouse_.waiting()) look();
  look();
  EXPECT_LT(ImGui::GetIO().MouseDoubleClickTime, 0.5f);
}

// On a computer that draws seldom, Ctrl is released before its click is processed.
TEST_F(MouseInputTest, AClickKeepsTheModifiersThatWereHeld) {
  ask(0);
  move(100, 50);
  mouse_.button(0, true, GLFW_MOD_CONTROL);
  mouse_.button(0, false, 0);
  bool with_control = false;
  show_modifiers(false, false, false);
  mouse_.deal(now_);
  frame([&] { with_control = ImGui::GetIO().KeyCtrl && ImGui::GetIO().MouseClicked[0]; });
  EXPECT_TRUE(with_control);
  show_modifiers(false, false, false);
  look();
  EXPECT_FALSE(ImGui::GetIO().KeyCtrl);
  EXPECT_EQ(mouse_.taken(), 2);
}

}  // namespace
}  // namespace limpid
