// Pictures of plots, read back from triangles and letters: all stands where its value is.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "app/plot/plot.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/drawn_ink.h"
#include "tests/support/drawn_text.h"

namespace limpid {
namespace {

// A plot of ten seconds, drawn by itself.
class APicture : public ImGuiFrames {
 protected:
  APicture() {
    spec_.y = {.unit = "N", .zero_line = false};
    spec_.curves = {{.label = "one", .ink = Ink::hand}};
  }

  template <class Value>
  void fill(int channels, const Value& value, double tick = 1e-3) {
    history_.emplace(History::Options{.channels = channels, .tick = tick});
    std::vector<double> row(static_cast<std::size_t>(channels));
    for (int k = 0; k <= static_cast<int>(std::lround(10 / tick)); ++k) {
      for (int c = 0; c < channels; ++c) row[static_cast<std::size_t>(c)] = value(c, tick * k);
      history_->append(tick * k, row);
    }
  }
  void draw(int frames = 3) {
    if (!plot_) plot_.emplace(spec_);
    for (int i = 0; i < frames; ++i) {
      frame([&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({700, 400});
        ImGui::Begin("plots", nullptr, ImGuiWindowFlags_NoDecoration);
        group_.begin_frame(*history_);
        plot_->draw(*history_, group_, {660, 360});
        ImGui::End();
      });
    }
    picture_.emplace(plot_->picture(group_));
    texts_ = test::drawn_texts();
  }

  const ScreenRect& area() const { return plot_->area(); }
  float y_of(double value) const {
    return area().max.y - static_cast<float>(picture_->y.part(value)) * area().height();
  }
  // `value`: a time, or a number along the horizontal axis.
  float x_of(double value) const {
    const bool over_time = spec_.kind == PlotKind::time;
    const double part = over_time ? (value - picture_->start) / (picture_->stop - picture_->start)
                                  : picture_->x.part(value);
    return area().min.x + static_cast<float>(part) * area().width();
  }
  // Tells whether a triangle of this colour, however faint, covers a place.
  static bool inked(ImVec2 at, Rgb rgb) {
    const ImU32 wanted = colour(rgb) & ~IM_COL32_A_MASK;
    return test::inked(at, [&](ImU32 ink) { return (ink & ~IM_COL32_A_MASK) == wanted; });
  }
  // The highest corner of this colour within the area of the curves.
  ImVec2 highest_of(Rgb rgb) const {
    const ImU32 wanted = colour(rgb) & ~IM_COL32_A_MASK;
    ImVec2 highest{0, area().max.y};
    const ImDrawData& data = *ImGui::GetDrawData();
    for (int n = 0; n < data.CmdListsCount; ++n) {
      for (const ImDrawVert& v : data.CmdLists[n]->VtxBuffer) {
        const bool same = (v.col & ~IM_COL32_A_MASK) == wanted;
        if (same && area().contains(v.pos) && v.pos.y < highest.y) highest = v.pos;
      }
    }
    return highest;
  }
  Rgb rgb(std::size_t curve = 0) const {
    return colour_of(current_palette(), plot_->spec().curves[curve]);
  }
  // Expects the curve at a value, and nothing of it well above and below.
  void expect_at(double x, double y, std::size_t curve = 0, float apart = 14) const {
    const ImVec2 at{x_of(x), y_of(y)};
    EXPECT_TRUE(inked(at, rgb(curve))) << x << ", " << y;
    EXPECT_FALSE(inked({at.x, at.y - apart}, rgb(curve))) << "above " << x << ", " << y;
    EXPECT_FALSE(inked({at.x, at.y + apart}, rgb(curve))) << "below " << x << ", " << y;
  }
  const test::DrawnText* find(const std::string& text) const {
    const auto found = std::ranges::find(texts_, text, &test::DrawnText::text);
    return found == texts_.end() ? nullptr : &*found;
  }

  PlotSpec spec_;
  std::optional<History> history_;
  std::optional<Plot> plot_;
  std::optional<PlotPicture> picture_;
  PlotGroup group_;
  std::vector<test::DrawnText> texts_;
};

double wave(double t) { return 3 + 2 * std::sin(0.4 * std::numbers::pi * t); }

TEST_F(APicture, HasEachCurveAtItsValues) {
  spec_.curves = {{.label = "one", .ink = Ink::hand},
                  {.channel = 1, .label = "two", .ink = Ink::contact},
                  {.channel = 2, .label = "hidden", .ink = Ink::energy, .visible = false}};
  fill(3, [](int c, double t) { return c == 0 ? wave(t) : c == 1 ? 1.5 : 4.0; });
  draw();
  for (double t = 0.5; t < 10; t += 0.37) {
    expect_at(t, wave(t));
    EXPECT_TRUE(inked({x_of(t), y_of(1.5)}, rgb(1))) << t;
    EXPECT_FALSE(inked({x_of(t), y_of(4)}, rgb(2))) << t;
  }
}

TEST_F(APicture, JoinsSamplesThatAreFarApart) {
  fill(
      1, [](int, double t) { return std::fmod(t, 2) < 0.9 ? 1.0 : 3.0; }, 1);
  draw();
  for (int t = 1; t < 10; ++t) EXPECT_TRUE(inked({x_of(t), y_of(t % 2 == 0 ? 1 : 3)}, rgb())) << t;
  for (int t = 1; t < 9; ++t) expect_at(t + 0.5, 2);
}

// A signal that jumps every millisecond fills its height.
TEST_F(APicture, FillsWhatLiesWithinAPixel) {
  fill(1,
       [](int, double t) { return std::lround(1000 * t) % 2 == 0 ? 1.0 : 3 + (t > 5 ? 0.5 : 0); });
  draw();
  for (double t = 0.6; t < 10; t += 0.5) {
    const double top = t > 5 ? 3.5 : 3;
    for (const double part : {0.05, 0.3, 0.5, 0.95}) {
      EXPECT_TRUE(inked({x_of(t), y_of(1 + part * (top - 1))}, rgb())) << t << ", " << part;
    }
    EXPECT_FALSE(inked({x_of(t), y_of(top) - 6}, rgb())) << t;
    EXPECT_FALSE(inked({x_of(t), y_of(1) + 6}, rgb())) << t;
  }
}

TEST_F(APicture, LeavesOutWhatIsNoNumber) {
  fill(1, [](int, double t) { return t > 4 && t < 6 ? std::nan("") : 2 + 0.01 * t; });
  draw();
  EXPECT_TRUE(inked({x_of(3), y_of(2.03)}, rgb()));
  EXPECT_TRUE(inked({x_of(7), y_of(2.07)}, rgb()));
  for (const double t : {4.2, 5.0, 5.8}) EXPECT_FALSE(inked({x_of(t), y_of(2 + 0.01 * t)}, rgb()));
}

// Numbers at the left stand at their values, in the axis' own unit, and seconds below at their
// times.
TEST_F(APicture, HasItsNumbersAtTheirPlaces) {
  spec_.y = {.unit = "mN", .factor = 1e3, .zero_line = false};
  fill(1, [](int, double t) { return 1e-3 * wave(t); });
  draw();
  int left = 0, below = 0;
  for (const test::DrawnText& each : texts_) {
    char* end = nullptr;
    const double number = std::strtod(each.text.c_str(), &end);
    if (end == each.text.c_str()) continue;
    if (each.max.x < area().min.x && *end == '\0') {
      ++left;
      EXPECT_NEAR(each.middle().y, y_of(1e-3 * number), 5) << each.text;
    } else if (each.min.y > area().max.y) {
      ++below;
      if (each.min.x > area().min.x && each.max.x < area().max.x) {
        EXPECT_NEAR(each.middle().x, x_of(number), 4) << each.text;
      }
    }
  }
  EXPECT_GE(left, 3);
  EXPECT_GE(below, 4);
}

TEST_F(APicture, EmphasizesZeroWhereItIsInSight) {
  const Rgb axis = current_palette().axis;
  spec_.y.zero_line = true;
  fill(1, [](int, double t) { return wave(t) - 3; });
  draw();
  for (const float part : {0.1f, 0.5f, 0.9f}) {
    const float x = area().min.x + part * area().width();
    EXPECT_TRUE(inked({x, std::round(y_of(0)) + 0.5f}, axis)) << part;
    EXPECT_FALSE(inked({x, y_of(1)}, axis)) << part;
  }
}

TEST_F(APicture, KeepsZeroInSightOnlyWhereItMatters) {
  fill(1, [](int, double t) { return 100 + wave(t); });
  draw();
  EXPECT_GT(picture_->y.limits.low, 90);
  spec_.y.zero_line = true;
  plot_.reset();
  draw();
  EXPECT_LE(picture_->y.limits.low, 0);
}

TEST_F(APicture, HasAThresholdWithItsNameAtItsValue) {
  spec_.thresholds = {{3.5, "limit", Ink::energy}};
  fill(1, [](int, double t) { return wave(t); });
  draw();
  const Rgb rgb = ink(current_palette(), Ink::energy);
  int found = 0;
  for (float x = area().min.x; x < area().max.x; ++x) {
    found += inked({x + 0.5f, std::round(y_of(3.5)) + 0.5f}, rgb);
    EXPECT_FALSE(inked({x + 0.5f, y_of(3.5) + 25}, rgb));
  }
  EXPECT_NEAR(found, area().width() / 2, 12) << "dashes";
  ASSERT_TRUE(find("limit"));
  EXPECT_LT(find("limit")->max.y, y_of(3.5) + 1);
  EXPECT_GT(find("limit")->max.y, y_of(3.5) - 10);
}

TEST_F(APicture, HasMarksAtTheirTimes) {
  fill(1, [](int, double t) { return wave(t); });
  history_->mark(2, "here", kNoteMark);
  history_->mark(9.9, "a change");
  draw();
  const Rgb text = current_palette().text;
  for (const float part : {0.3f, 0.7f}) {
    const float y = area().min.y + part * area().height();
    EXPECT_TRUE(inked({std::round(x_of(2)) + 0.5f, y}, text));
    EXPECT_FALSE(inked({x_of(2) + 5, y}, text));
  }
  ASSERT_TRUE(find("here"));
  EXPECT_GT(find("here")->min.x, x_of(2));
  EXPECT_LT(find("here")->min.x, x_of(2) + 12);
  ASSERT_TRUE(find("a change"));
  EXPECT_LT(find("a change")->max.x, x_of(9.9)) << "left of it, where there is room";
}

TEST_F(APicture, TintsAndNamesTheStretchesOfABand) {
  spec_.bands = {{.channel = 1, .names = {"", "contact"}}};
  fill(2, [](int c, double t) { return c == 0 ? wave(t) : t > 4 && t < 8 ? 1 : 0; });
  draw();
  const Rgb tint = current_palette().accent;
  const float y = y_of(4.9);
  EXPECT_FALSE(inked({x_of(3.9), y}, tint));
  EXPECT_TRUE(inked({x_of(4.1), y}, tint));
  EXPECT_TRUE(inked({x_of(7.9), y}, tint));
  EXPECT_FALSE(inked({x_of(8.1), y}, tint));
  ASSERT_TRUE(find("contact"));
  EXPECT_NEAR(find("contact")->min.x, x_of(4), 6);
}

// The predictive law, interrupted just after it began, is named where it has room.
TEST_F(APicture, NamesEachLawThatHasRoom) {
  spec_.bands = {{.channel = 1, .names = {"standard", "predictive"}, .laws = true}};
  fill(2, [](int c, double t) {
    return c == 0 ? wave(t) : t < 4 ? 0 : t > 4.1 && t < 5 ? std::nan("") : 1;
  });
  draw();
  ASSERT_TRUE(find("standard"));
  ASSERT_TRUE(find("predictive"));
  EXPECT_NEAR(find("predictive")->min.x, x_of(5), 6);
}

TEST_F(APicture, NamesALawWhereTheNameBeforeEnds) {
  spec_.bands = {{.channel = 1, .names = {"standard", "proposed"}, .laws = true}};
  double until = 5;
  const auto value = [&](int c, double t) { return c == 0 ? wave(t) : t < until ? 0.0 : 1.0; };
  fill(2, value);
  draw();
  ASSERT_TRUE(find("standard"));
  // The first law lasts as long as its name is wide, and a little longer.
  const float wide = find("standard")->max.x - area().min.x + 4;
  until = static_cast<double>(wide / (x_of(1) - x_of(0)));
  fill(2, value);
  plot_.reset();
  draw();
  ASSERT_TRUE(find("standard"));
  ASSERT_TRUE(find("proposed"));
  EXPECT_GT(find("proposed")->min.x, find("standard")->max.x + 6);
  EXPECT_LT(find("proposed")->min.x, find("standard")->max.x + 20);
}

// A recorded run has a tint and the first edge, its re-run the second one: names hide neither.
TEST_F(APicture, NamesLawsBelowAllEdges) {
  spec_.bands = {{.channel = 1, .names = {"recorded standard", "recorded proposed"}, .laws = true},
                 {.channel = 2, .names = {"standard", "re-run"}, .laws = true, .lane = 1}};
  fill(3, [](int c, double t) { return c == 0 ? wave(t) : t < 5 ? 0.0 : 1.0; });
  draw();
  const float x = x_of(8), top = area().min.y;
  const Rgb law = law_ink(current_palette(), 1);
  for (const char* name : {"recorded proposed", "re-run"}) {
    ASSERT_TRUE(find(name)) << name;
    EXPECT_GT(find(name)->min.y, top + 7) << name;
  }
  EXPECT_TRUE(inked({x, top + 1.5f}, law));
  EXPECT_TRUE(inked({x, top + 5.5f}, law));
  EXPECT_GT(find("re-run")->min.y, find("recorded proposed")->max.y - 3) << "in the next line";
}

TEST_F(APicture, TintsTheSelectedStretchAsFarAsItIsInSight) {
  fill(1, [](int, double t) { return wave(t); });
  const Rgb tint = current_palette().accent;
  const auto tinted = [&](double t) { return inked({x_of(t), y_of(4.9)}, tint); };
  group_.select(PlotRange{.start = 3, .stop = 9});
  draw();
  for (const double t : {2.9, 9.1}) EXPECT_FALSE(tinted(t)) << t;
  for (const double t : {3.1, 6.0, 8.9}) EXPECT_TRUE(tinted(t)) << t;
  group_.zoom(0.4, 10);
  draw();
  ASSERT_NEAR(picture_->start, 6, 0.1);
  for (const double t : {6.1, 8.9}) EXPECT_TRUE(tinted(t)) << t;
  EXPECT_FALSE(tinted(9.1));
  group_.select(PlotRange{.start = 3, .stop = 5});
  draw();
  for (float x = 0.25f; x < area().width(); x += 0.5f) {
    ASSERT_FALSE(inked({area().min.x + x, y_of(4.9)}, tint)) << x;
  }
}

TEST_F(APicture, OverAnotherChannelHasPairsOfValues) {
  spec_.kind = PlotKind::cross;
  spec_.x = {.label = "across", .unit = "m", .zero_line = false};
  spec_.curves[0].across = 1;
  fill(2, [](int c, double t) {
    const double angle = 0.2 * std::numbers::pi * t;
    return c == 0 ? 10 + 3 * std::sin(angle) : 5 + std::cos(angle);
  });
  draw();
  for (double angle = 0.1; angle < 6.2; angle += 0.3) {
    EXPECT_TRUE(inked({x_of(5 + std::cos(angle)), y_of(10 + 3 * std::sin(angle))}, rgb())) << angle;
  }
  EXPECT_FALSE(inked({x_of(5), y_of(10)}, rgb())) << "within the circle";
  EXPECT_FALSE(inked({x_of(5.5), y_of(10)}, rgb()));
}

// Amplitudes of a sine are highest at its frequency.
TEST_F(APicture, OfASpectrumHasItsPeakAtTheFrequency) {
  spec_.kind = PlotKind::spectrum;
  spec_.x = {.label = "frequency", .unit = "Hz", .zero_line = false, .log = true};
  spec_.y.log = true;
  fill(1, [](int, double t) { return 2 * std::sin(2 * std::numbers::pi * 40 * t); });
  draw(40);
  const ImVec2 peak = highest_of(rgb());
  EXPECT_LT(peak.y, area().min.y + 0.5f * area().height());
  EXPECT_NEAR(peak.x, x_of(40), 6);
}

}  // namespace
}  // namespace limpid
