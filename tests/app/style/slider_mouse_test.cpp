// Effects of the mouse on a slider, frame by frame.
#include <gtest/gtest.h>

#include <cmath>

#include "app/style/sliders.h"
#include "tests/app/plot/imgui_frames.h"

namespace limpid {
namespace {

constexpr float kLeft = 100, kTop = 50, kWidth = 400, kTrack = 75;  // place of the slider [px]

class SliderMouse : public ImGuiFrames {
 protected:
  // ImGui 1.90 lets no window be hovered before its third frame.
  SliderMouse() { draw(), draw(); }

  void draw(float seconds = 0.02f) {
    frame(
        [&] {
          ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
          ImGui::SetNextWindowPos({kLeft, kTop});
          ImGui::SetNextWindowSize({kWidth, 100});
          ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
          const ParameterInfo& eta = *find_parameter("coupling.eta");
          const bool changed = of_value ? value_slider(eta, parameters.eta, 1)
                                        : parameter_slider(eta, parameters, 1);
          if (changed) given = parameters.eta;
          changes += changed ? 1 : 0;
          ImGui::End();
          ImGui::PopStyleVar();
        },
        seconds);
  }
  void move(float x) {
    show_mouse({x, kTrack});
    draw();
  }
  void button(bool down) {
    show_mouse_button(0, down);
    draw();
  }
  void click(float x) {
    move(x);
    button(true);
    button(false);
  }
  void wait(double seconds) {
    for (double t = 0; t < seconds; t += 0.05) draw(0.05f);
  }
  void type(const char* text) {
    click(kLeft + 0.9f * kWidth);
    click(kLeft + 0.9f * kWidth);
    ImGui::GetIO().AddInputCharactersUTF8(text);
    draw();
    key(GLFW_KEY_ENTER);
    wait(1);  // otherwise the next click is a third one
  }
  void key(int which) {
    for (const bool down : {true, false}) {
      show_key(which, down);
      draw();
    }
  }

  Parameters parameters;  // eta 1, in the middle of a slider from 0.1 to 10
  int changes = 0;
  double given = 1;  // given at once by the last change
  bool of_value = false;
};

TEST_F(SliderMouse, DoubleClickToTypeLeavesTheValueAlone) {
  click(kLeft + 0.9f * kWidth);
  click(kLeft + 0.9f * kWidth);
  wait(1);
  EXPECT_EQ(parameters.eta, 1);
  EXPECT_EQ(changes, 0) << "every change would be a step of undo";
  ImGui::GetIO().AddInputCharactersUTF8("0.25");
  draw();
  EXPECT_EQ(parameters.eta, 1) << "not while it is being typed";
  key(GLFW_KEY_ENTER);
  EXPECT_EQ(parameters.eta, 0.25);
  EXPECT_EQ(changes, 1);
}

TEST_F(SliderMouse, ACommaThatIsTypedIsTheDecimalPoint) {
  type("0,25");
  EXPECT_EQ(parameters.eta, 0.25);
}

TEST_F(SliderMouse, WhatIsTypedBeyondTheLimitsIsNotTaken) {
  const ParameterInfo& eta = *find_parameter("coupling.eta");
  for (const bool other : {false, true}) {
    of_value = other;
    parameters.eta = given = 1;
    changes = 0;
    for (const char* wrong : {"1e9", "-3", "0", "nan", "banana"}) {
      type(wrong);
      EXPECT_EQ(given, 1) << other << " " << wrong;
      EXPECT_EQ(parameters.eta, 1) << other << " " << wrong;
    }
    EXPECT_EQ(changes, 0) << other;
    for (const double limit : {eta.maximum, eta.minimum}) {
      type(std::to_string(limit).c_str());
      EXPECT_EQ(parameters.eta, limit) << other;
    }
  }
}

TEST_F(SliderMouse, EscapeEndsTypingWithTheValueAsItWas) {
  click(kLeft + 0.9f * kWidth);
  click(kLeft + 0.9f * kWidth);
  ImGui::GetIO().AddInputCharactersUTF8("7");
  draw();
  key(GLFW_KEY_ESCAPE);
  wait(1);
  EXPECT_EQ(parameters.eta, 1);
  EXPECT_EQ(changes, 0);
}

TEST_F(SliderMouse, SingleClickMovesTheValueOnceNoSecondOneHasCome) {
  click(kLeft + 0.75f * kWidth);
  EXPECT_EQ(parameters.eta, 1);
  wait(0.6);
  EXPECT_NEAR(parameters.eta, std::sqrt(10), 0.1) << "three quarters of 0.1 to 10";
  EXPECT_EQ(changes, 1);
}

TEST_F(SliderMouse, DragMovesTheValueAtOnce) {
  move(kLeft + 0.5f * kWidth);
  button(true);
  move(kLeft + 0.75f * kWidth);
  EXPECT_NEAR(parameters.eta, std::sqrt(10), 0.1);
  move(kLeft + 0.25f * kWidth);
  EXPECT_NEAR(parameters.eta, 1 / std::sqrt(10), 0.01);
  button(false);
  wait(1);
  EXPECT_NEAR(parameters.eta, 1 / std::sqrt(10), 0.01);
}

TEST_F(SliderMouse, HeldStillOnTheTrackMovesTheValueThere) {
  move(kLeft + 0.75f * kWidth);
  button(true);
  wait(0.6);
  EXPECT_NEAR(parameters.eta, std::sqrt(10), 0.1);
}

}  // namespace
}  // namespace limpid
