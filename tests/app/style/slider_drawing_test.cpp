// Sliders, check boxes and rows of choices as they are drawn, at twice the usual scale.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "app/style/palette.h"
#include "app/style/sliders.h"
#include "app/style/theme.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/drawn_shapes.h"
#include "tests/support/drawn_text.h"

namespace limpid {
namespace {

using test::drawn_shapes;
using testing::HasSubstr;

constexpr float kLetterWide = 7 * 32 / 13.0f;  // of ImGui's own font [px]
constexpr FieldInfo kWide{{0, 20, false, "mm"},    "a.wide", "w", "Width", "How wide it is.",
                          FieldInfo::Kind::number, 0,        10};

// A panel from 100, 50 on, in which `draw_` draws.
class DrawnSliders : public ImGuiFrames {
 protected:
  DrawnSliders() { ImGui::GetIO().FontGlobalScale = 32 / 13.0f; }
  void draw(int frames = 3, float seconds = 0.02f) {
    for (int i = 0; i < frames; ++i) {
      frame(
          [&] {
            ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
            ImGui::SetNextWindowPos({100, 50});
            ImGui::SetNextWindowSize({width_, 300});
            ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
            changes_ += draw_() ? 1 : 0;
            ImGui::End();
            ImGui::PopStyleVar();
          },
          seconds);
    }
  }
  void point(ImVec2 at) {
    show_mouse(at);
    draw();
  }
  void click(ImVec2 at, int which = 0) {
    point(at);
    for (const bool down : {true, false}) {
      show_mouse_button(which, down);
      draw();
    }
  }
  static test::DrawnText text(const std::string& begins) {
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.text.starts_with(begins)) return each;
    }
    ADD_FAILURE() << "nothing says: " << begins;
    return {};
  }
  static bool shown(const std::string& begins) {
    return std::ranges::any_of(test::drawn_texts(), [&](const test::DrawnText& each) {
      return each.text.starts_with(begins);
    });
  }
  // All lines of the tooltip.
  static std::string tip() {
    std::string all;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window.starts_with("##Tooltip")) all += (all.empty() ? "" : " ") + each.text;
    }
    return all;
  }
  static void expect_box(const test::DrawnShape& shape, ImVec2 min, ImVec2 max, float within) {
    EXPECT_NEAR(shape.min.x, min.x, within);
    EXPECT_NEAR(shape.min.y, min.y, within);
    EXPECT_NEAR(shape.max.x, max.x, within);
    EXPECT_NEAR(shape.max.y, max.y, within);
  }
  static const Palette& p() { return current_palette(); }

  float width_ = 400;
  std::function<bool()> draw_;
  int changes_ = 0;
};

// A track from 112 to 488 in the middle of which, at 100, a knob stands at the value.
class ADrawnNumber : public DrawnSliders {
 protected:
  ADrawnNumber() {
    draw_ = [this] {
      ImGui::PushID("number");
      const bool changed = number_slider(kWide, value_, {2, 8}, broken_);
      ImGui::PopID();
      return changed;
    };
    draw();
  }
  double value_ = 4;
  bool broken_ = false;
};

TEST_F(ADrawnNumber, HasItsNameItsValueAKnobAndMarks) {
  EXPECT_NEAR(text("Width").at.x, 100, 1);
  EXPECT_NEAR(text("Width").at.y, 50, 1);
  EXPECT_EQ(text("Width").colour, colour(p().text));
  EXPECT_EQ(text("4.00").text, "4.00 mm");
  EXPECT_NEAR(text("4.00").at.x, 500 - 7 * kLetterWide, 1.5);
  EXPECT_NEAR(text("4.00").at.y, 50, 1);
  EXPECT_EQ(text("4.00").colour, colour(p().text));
  const float x = 112 + 0.4f * 376;
  const auto rail = drawn_shapes(colour(p().frame_hovered));
  ASSERT_EQ(rail.size(), 1u);
  expect_box(rail[0], {112, 96}, {488, 104}, 0.8f);
  const auto filled = drawn_shapes(colour(mix(p().axis, p().accent, 0.35f)));
  ASSERT_EQ(filled.size(), 1u);
  expect_box(filled[0], {112, 96}, {x, 104}, 0.8f);
  const auto knob = drawn_shapes(colour(p().accent));
  ASSERT_EQ(knob.size(), 1u);
  expect_box(knob[0], {x - 9, 91}, {x + 9, 109}, 0.8f);
  const auto rim = drawn_shapes(colour(p().panel));
  ASSERT_EQ(rim.size(), 1u);
  expect_box(rim[0], {x - 11, 89}, {x + 11, 111}, 0.8f);
  const auto usual = drawn_shapes(colour(p().muted));
  ASSERT_EQ(usual.size(), 1u);
  expect_box(usual[0], {187 - 1.5f, 88}, {187 + 1.5f, 112}, 0.1f);
  const auto limit = drawn_shapes(colour(p().broken));
  ASSERT_EQ(limit.size(), 1u);
  expect_box(limit[0], {413 - 1.5f, 88}, {413 + 1.5f, 112}, 0.1f);
}

TEST_F(ADrawnNumber, IsRedWithAFrameWhereItBreaksAPromise) {
  broken_ = true;
  draw();
  EXPECT_EQ(text("4.00").colour, colour(p().broken));
  const auto red = drawn_shapes(colour(p().broken));
  ASSERT_EQ(red.size(), 4u) << "the limit, the rail, the knob and the frame";
  expect_box(red[1], {112, 96}, {112 + 0.4f * 376, 104}, 0.8f);
  expect_box(red[3], {94, 49}, {506, 115}, 2.6f);
  EXPECT_TRUE(drawn_shapes(colour(p().accent)).empty());
}

TEST_F(ADrawnNumber, HasNoKnobWithoutANumber) {
  value_ = std::nan("");
  draw();
  EXPECT_EQ(text("automatic").colour, colour(p().muted));
  EXPECT_TRUE(drawn_shapes(colour(p().accent)).empty());
  EXPECT_EQ(drawn_shapes(colour(p().muted)).size(), 1u) << "the marks stay";
}

TEST_F(ADrawnNumber, LeavesOutItsUnitInANarrowPanel) {
  width_ = 230;
  draw();
  EXPECT_EQ(text("4.00").text, "4.00");
  EXPECT_NEAR(text("4.00").at.x, 330 - 4 * kLetterWide, 1.5);
  width_ = 250;  // 5 letters, a gap of 32 px, 7 letters
  draw();
  EXPECT_EQ(text("4.00").text, "4.00 mm");
}

TEST_F(ADrawnNumber, ShowsThatTheMouseIsOnItOrHoldsIt) {
  point({300, 100});
  EXPECT_EQ(drawn_shapes(colour(p().frame_active)).size(), 1u);
  EXPECT_TRUE(drawn_shapes(colour(p().frame_hovered)).empty());
  show_mouse_button(0, true);
  draw();
  const auto knob = drawn_shapes(colour(p().text));
  ASSERT_EQ(knob.size(), 1u);
  EXPECT_NEAR(knob[0].width(), 2 * 11 - 1, 0.8);
  show_mouse_button(0, false);
  draw();
  EXPECT_TRUE(drawn_shapes(colour(p().text)).empty());
}

TEST_F(ADrawnNumber, GoesBackToItsUsualValueByARightClick) {
  click({300, 60}, 1);
  EXPECT_EQ(value_, 2);
  EXPECT_EQ(changes_, 1);
  click({300, 100}, 1);
  EXPECT_EQ(changes_, 1) << "it is there";
  click({300, 60});
  draw(40);
  EXPECT_EQ(value_, 2) << "a click on the name leaves it alone";
  click({488 - 37.6f, 100});
  draw(40);
  EXPECT_NEAR(value_, 9, 0.05) << "one on the track does not";
  EXPECT_EQ(changes_, 2);
}

TEST_F(ADrawnNumber, SaysWhatIsAllowedWhereSomethingElseWasTyped) {
  const auto type = [&](const char* number) {
    point({300, 100});
    show_modifiers(true, false, false);
    draw(1);
    show_mouse_button(0, true);
    draw(1);
    show_mouse_button(0, false);
    draw(1);
    show_modifiers(false, false, false);
    draw(2);
    ImGui::GetIO().AddInputCharactersUTF8(number);
    draw(1);
    for (const bool down : {true, false}) {
      show_key(GLFW_KEY_ENTER, down);
      draw(1);
    }
    draw(1);
  };
  width_ = 690;  // for all of the words
  type("21");
  EXPECT_EQ(value_, 4);
  EXPECT_EQ(text("not accepted").text, "not accepted; allowed: 0 to 20.0 mm");
  EXPECT_EQ(text("not accepted").colour, colour(p().broken));
  EXPECT_FALSE(shown("Width")) << "in place of the name";
  draw(210);
  EXPECT_FALSE(shown("not accepted")) << "for four seconds";
  type("12,5");
  EXPECT_EQ(value_, 12.5) << "also beyond the track";
  EXPECT_EQ(changes_, 1);
  EXPECT_FALSE(shown("not accepted"));
}

// Widgets of settings, at the usual scale.
class ADrawnSetting : public DrawnSliders {
 protected:
  ADrawnSetting() { ImGui::GetIO().FontGlobalScale = 16 / 13.0f; }
  void show(const char* key, double usual, const char* broken = nullptr) {
    draw_ = [=, this] { return parameter_slider(*find_parameter(key), now_, usual, broken); };
    draw();
  }
  std::string tip_at(ImVec2 at) {
    point(at);
    EXPECT_EQ(tip(), "") << "not at once";
    draw(15, 0.05f);
    return tip();
  }
  Parameters now_;
};

TEST_F(ADrawnSetting, ExplainsItselfToAMouseThatStays) {
  show("loop.tick", 1e-3);
  const std::string tick = tip_at({300, 60});
  EXPECT_THAT(tick, HasSubstr("Time between two ticks of the loop, T."));
  EXPECT_THAT(tick, HasSubstr("loop.tick, 1.00e-05 to 0.100 s"));
  EXPECT_THAT(tick, HasSubstr("Usual: 0.00100 s (right click sets it). Double click to type."));
  EXPECT_THAT(tick, HasSubstr("Takes effect when the loop starts again."));
  point({790, 590});
  show("observer.alpha", 0.5, "No promise holds.");
  const std::string alpha = tip_at({300, 60});
  EXPECT_TRUE(alpha.starts_with("No promise holds.")) << alpha;
  EXPECT_THAT(alpha, HasSubstr("Paper: 0.500"));
  EXPECT_THAT(alpha, testing::Not(HasSubstr("Takes effect")));
}

TEST_F(ADrawnSetting, IsACheckBoxForWhatIsOnOrOff) {
  show("observer.anti_windup", 1);
  EXPECT_TRUE(now_.anti_windup);
  click({110, 60});
  EXPECT_FALSE(now_.anti_windup);
  EXPECT_EQ(changes_, 1);
  click({110, 60}, 1);
  EXPECT_TRUE(now_.anti_windup) << "a right click sets the usual value";
  EXPECT_EQ(changes_, 2);
  click({110, 60}, 1);
  EXPECT_EQ(changes_, 2);
  point({790, 590});
  EXPECT_THAT(tip_at({110, 60}),
              HasSubstr("observer.anti_windup. Right click sets the default value."));
  EXPECT_TRUE(drawn_shapes(colour(p().broken)).empty());
  show("observer.anti_windup", 1, "broken");
  EXPECT_EQ(drawn_shapes(colour(p().broken)).size(), 1u) << "a frame";
}

// Side by side below their name, each as wide as the others: 10 laws of 40 px.
TEST_F(ADrawnSetting, IsARowOfChoicesForAFewWords) {
  now_.kind = CouplingKind::proposed;
  show("coupling.kind", static_cast<double>(CouplingKind::standard));
  EXPECT_NEAR(text("Coupling").at.y, 50, 1);
  const auto chosen = [&] { return drawn_shapes(colour(p().accent)); };
  ASSERT_EQ(chosen().size(), 1u);
  EXPECT_NEAR(chosen()[0].min.x, 140, 0.8);
  EXPECT_NEAR(chosen()[0].max.x, 180, 0.8);
  const float row = chosen()[0].middle().y;
  EXPECT_GT(row, 50 + 16);
  const auto back = drawn_shapes(colour(p().frame));
  ASSERT_EQ(back.size(), 1u);
  expect_box(back[0], {100, chosen()[0].min.y}, {500, chosen()[0].max.y}, 0.8f);
  click({100 + 2.5f * 40, row});
  EXPECT_EQ(now_.kind, CouplingKind::predictive);
  EXPECT_EQ(changes_, 1);
  EXPECT_NEAR(chosen().at(0).min.x, 180, 0.8);
  click({100 + 2.5f * 40, row});
  EXPECT_EQ(changes_, 1) << "it is chosen";
  point({100 + 4.5f * 40, row});
  const auto pointed = drawn_shapes(colour(p().frame_active));
  ASSERT_EQ(pointed.size(), 1u);
  EXPECT_NEAR(pointed[0].middle().x, 280, 0.8);
  click({100 + 4.5f * 40, row}, 1);
  EXPECT_EQ(now_.kind, CouplingKind::standard) << "the usual one";
}

TEST_F(DrawnSliders, OfAFieldKeepToItsNumbers) {
  double value = 4;
  draw_ = [&] { return value_slider(kWide, value, 7); };
  draw();
  click({300, 60}, 1);
  EXPECT_EQ(value, 7);
  point({400, 60});
  EXPECT_EQ(tip(), "How wide it is.");
}

}  // namespace
}  // namespace limpid
