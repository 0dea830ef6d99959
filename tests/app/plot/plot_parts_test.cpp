// Parts of a plot, drawn by themselves at twice the usual scale: axes, curves, signs and labels
// stand where their values are, in their own sizes.
#include <array>
#include <cmath>

#include "tests/app/plot/a_part.h"

namespace limpid {
namespace {

TEST_F(APart, HasALineAndANumberForEachSecondAndEachValue) {
  draw([&](const PlotFrame& in) { draw_axes(in, spec_, 0); });
  const auto grid = test::drawn_shapes(colour(palette_.grid));
  ASSERT_EQ(grid.size(), 7u + 11u);
  for (int i = 0; i <= 6; ++i) {
    const float x = 60 + 100 * static_cast<float>(i);
    expect_box(grid[static_cast<std::size_t>(i)], {x, 40}, {x + 1, 480});
    expect_said(std::to_string(i) + " s", {i == 0 ? 53.7f : x - 10.5f, 488}, palette_.muted);
  }
  for (int i = 0; i <= 10; ++i) {
    const float y = 480 - 44 * static_cast<float>(i);
    expect_box(grid[static_cast<std::size_t>(7 + i)], {60, y}, {660, y + 1});
    // Numbers end 12 px left of the area; those at its ends are pushed inwards.
    const float top = std::clamp(y - 6.5f, 37.0f, 470.0f);
    expect_said(std::to_string(i), {60 - 12 - (i < 10 ? 7.0f : 14.0f), top}, palette_.muted);
  }
  const auto zero = test::drawn_shapes(colour(palette_.axis));
  ASSERT_EQ(zero.size(), 1u);
  expect_box(zero[0], {60, 480}, {660, 481});
  // Times count from the run's own beginning.
  y_.limits = {20, 30};
  draw([&](const PlotFrame& in) { draw_axes(in, spec_, 2.5); });
  expect_said("0 s", {310 - 10.5f, 488}, palette_.muted);
  expect_said("3 s", {610 - 10.5f, 488}, palette_.muted);
  EXPECT_FALSE(says("4 s"));
  EXPECT_TRUE(test::drawn_shapes(colour(palette_.axis)).empty()) << "zero is not in sight";
}

TEST_F(APart, NamesWhatIsAlongItsHorizontalAxis) {
  spec_.kind = PlotKind::cross;
  spec_.x = {.label = "way", .unit = "m"};
  x_.limits = {-2, 4};
  y_.limits = {20, 30};
  draw([&](const PlotFrame& in) { draw_axes(in, spec_, 0); });
  expect_said("way  m", {660 - 42, 488}, palette_.text);
  for (int i = 0; i <= 3; ++i) {
    expect_said(std::to_string(i), {260 + 100 * static_cast<float>(i) - 3.5f, 488}, palette_.muted);
  }
  EXPECT_FALSE(says("4")) << "the name stands there";
  const auto zero = test::drawn_shapes(colour(palette_.axis));
  ASSERT_EQ(zero.size(), 1u);
  expect_box(zero[0], {260, 40}, {261, 480});
  const auto grid = test::drawn_shapes(colour(palette_.grid));
  ASSERT_EQ(grid.size(), 7u + 11u);
  expect_box(grid[6], {660, 40}, {661, 480});
  spec_.x.zero_line = false;
  spec_.x.label = "";
  draw([&](const PlotFrame& in) { draw_axes(in, spec_, 0); });
  EXPECT_TRUE(test::drawn_shapes(colour(palette_.axis)).empty());
  expect_said("m", {653, 488}, palette_.text);
  spec_.x.label = std::string(100, 'w');
  draw([&](const PlotFrame& in) { draw_axes(in, spec_, 0); });
  const auto name = std::ranges::find_if(
      texts_, [](const test::DrawnText& each) { return each.text.starts_with("ww"); });
  ASSERT_NE(name, texts_.end());
  EXPECT_NEAR(name->at.x, 660 - 450, 1) << "three quarters of the width at most";
  EXPECT_LE(name->max.x, 660);
  EXPECT_GT(name->max.x, 645);
}

TEST_F(APart, CutsATextOffAtWholeLetters) {
  draw([&](const PlotFrame& in) {
    EXPECT_EQ(
        draw_clipped_text(in.list, Face::small, {10.4f, 20.6f}, palette_.text, "abcdefgh", 40),
        5 * 7);
    EXPECT_EQ(
        draw_clipped_text(in.list, Face::small, {10, 60}, palette_.muted, "\u00e4\u00f6\u00fc", 15),
        2 * 7);
    EXPECT_EQ(draw_clipped_text(in.list, Face::small, {10, 90}, palette_.text, "whole", 35), 35);
    EXPECT_EQ(draw_clipped_text(in.list, Face::small, {10, 120}, palette_.text, "none", 6), 0);
  });
  expect_said("abcd?", {10, 21}, palette_.text);
  expect_said("whole", {10, 90}, palette_.text);
  EXPECT_EQ(texts_.size(), 3u);
}

TEST_F(APart, DrawsEachRunOfALineInTheColourOfItsLaw) {
  Trace trace;
  TracePen pen(trace);
  for (int x = 0; x <= 100; x += 10) pen.put({static_cast<float>(x), 2, 2}, 0);
  pen.lift();
  for (int x = 200; x <= 300; x += 10) pen.put({static_cast<float>(x), 7, 7}, 1);
  const Curve curve{.law = 0, .law_channel = 1};
  std::array<float, 2> thick{};
  for (const float emphasis : {1.0f, 2.0f}) {
    draw([&](const PlotFrame& in) { draw_trace(in, trace, curve, emphasis); });
    const auto first = test::drawn_shapes(colour(law_ink(palette_, 0)));
    const auto second = test::drawn_shapes(colour(law_ink(palette_, 1)));
    ASSERT_EQ(first.size(), 1u);
    ASSERT_EQ(second.size(), 1u);
    EXPECT_NEAR(first[0].min.x, 60, 0.1);
    EXPECT_NEAR(first[0].max.x, 160, 0.1);
    EXPECT_NEAR(first[0].middle().y, 480 - 88, 0.1);
    EXPECT_NEAR(second[0].min.x, 260, 0.1);
    EXPECT_NEAR(second[0].max.x, 360, 0.1);
    EXPECT_NEAR(second[0].middle().y, 480 - 308, 0.1);
    EXPECT_EQ(first[0].corners, second[0].corners) << "a straight line has two ends";
    thick[emphasis > 1 ? 1 : 0] = first[0].height();
  }
  EXPECT_NEAR(thick[0], 4, 2.1) << "2 px at scale 1, with a rim or without";
  EXPECT_NEAR(thick[1] - thick[0], 4, 0.1);
  draw([&](const PlotFrame& in) { draw_trace(in, trace, curve, 0.3f); });
  EXPECT_EQ(test::drawn_shapes(colour(law_ink(palette_, 0), 0.3f)).size(), 1u) << "faded";
  EXPECT_NEAR(test::drawn_shapes()[0].height(), thick[0], 0.1) << "but as thick";
}

TEST_F(APart, DrawsALineThroughEachCornerAndDotsWhereSamplesAreFarApart) {
  const Rgb rgb = ink(palette_, Ink::hand);
  const auto dots = [&](float apart) {
    Trace trace;
    TracePen pen(trace);
    for (int i = 0; i <= 20; ++i) {
      const float value = i % 2 == 0 ? 4 : 4.5f;
      pen.put({apart * static_cast<float>(i), value, value});
    }
    draw([&](const PlotFrame& in) { draw_trace(in, trace, spec_.curves[0], 1); });
    auto all = test::drawn_shapes(colour(rgb));
    const test::DrawnShape line = all.at(0);
    EXPECT_NEAR(line.min.x, 60, 4);
    EXPECT_NEAR(line.max.x, 60 + 20 * apart, 4);
    EXPECT_NEAR(line.min.y, 480 - 198, 8);
    EXPECT_NEAR(line.max.y, 480 - 176, 8);
    EXPECT_GE(line.corners, 2 * 21) << "no corner is left out";
    all.erase(all.begin());
    return all;
  };
  EXPECT_TRUE(dots(13.9f).empty());
  const auto far = dots(14.1f);
  ASSERT_EQ(far.size(), 21u);
  for (std::size_t i = 0; i < far.size(); ++i) {
    EXPECT_NEAR(far[i].middle().x, 60 + 14.1f * static_cast<float>(i), 0.1);
    EXPECT_NEAR(far[i].middle().y, i % 2 == 0 ? 480 - 176 : 480 - 198, 0.1);
    EXPECT_NEAR(far[i].width(), 2 * 4.4f - 1, 0.6);
  }
}

TEST_F(APart, DrawsALongLineInPieces) {
  Trace trace;
  TracePen pen(trace);
  trace.wanders = true;
  for (int i = 0; i < 4500; ++i) pen.put({0.1f * static_cast<float>(i), 5, 5});
  draw([&](const PlotFrame& in) { draw_trace(in, trace, spec_.curves[0], 1); });
  const auto pieces = test::drawn_shapes(colour(ink(palette_, Ink::hand)));
  ASSERT_EQ(pieces.size(), 3u);
  const std::array ends{60.0f, 260.0f, 460.0f, 509.9f};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(pieces[i].min.x, ends[i], 0.1);
    EXPECT_NEAR(pieces[i].max.x, ends[i + 1], 0.1);
  }
}

// A band of values in each pixel: tall where the signal is noisy, as thick as a line elsewhere.
TEST_F(APart, FillsABandFromItsLowestToItsHighestValue) {
  const auto shapes = [&](int points, float low, float high) {
    Trace trace;
    TracePen pen(trace);
    trace.band = true;
    for (int i = 0; i < points; ++i) pen.put({100 + static_cast<float>(i), low, high});
    draw([&](const PlotFrame& in) { draw_trace(in, trace, spec_.curves[0], 1); });
    return test::drawn_shapes(colour(ink(palette_, Ink::hand)));
  };
  const auto tall = shapes(200, 4, 6);
  ASSERT_EQ(tall.size(), 1u) << "level edges need no more";
  expect_box(tall[0], {160, 480 - 264 - 1.5f}, {359, 480 - 176 + 1.5f});
  const auto thin = shapes(200, 5, 5);
  ASSERT_EQ(thin.size(), 1u);
  expect_box(thin[0], {160, 260 - 1.5f}, {359, 260 + 1.5f});
  const auto one = shapes(1, 4, 6);
  ASSERT_EQ(one.size(), 1u);
  expect_box(one[0], {159.5f, 480 - 264 - 2}, {160.5f, 480 - 176 + 2});
  // A signal that goes up and down all the time is drawn in groups that touch.
  Trace trace;
  TracePen pen(trace);
  trace.band = true;
  for (int i = 0; i < 50; ++i) {
    const float low = i % 2 == 0 ? 2 : 3;
    pen.put({100 + static_cast<float>(i), low, low + 4});
  }
  draw([&](const PlotFrame& in) { draw_trace(in, trace, spec_.curves[0], 1); });
  const auto groups = test::drawn_shapes(colour(ink(palette_, Ink::hand)));
  ASSERT_GT(groups.size(), 3u);
  EXPECT_NEAR(groups.front().min.x, 160, 0.1);
  EXPECT_NEAR(groups.back().max.x, 209, 0.1);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (i > 0) {
      EXPECT_NEAR(groups[i].min.x, groups[i - 1].max.x, 0.1);
    }
    EXPECT_NEAR(groups[i].min.y, 480 - 44 * 7 - 1.5f, 0.1);
    EXPECT_NEAR(groups[i].max.y, 480 - 44 * 2 + 1.5f, 0.1);
  }
}

TEST_F(APart, DrawsASignOfEachShapeOnItsRim) {
  const ImU32 front = colour(palette_.accent), back = colour(palette_.panel);
  const auto sign = [&](RunSign which) {
    draw([&](const PlotFrame& in) { draw_run_sign(in.list, {200, 100}, which, front, back, 2); });
    return std::pair(test::drawn_shapes(back), test::drawn_shapes(front));
  };
  EXPECT_TRUE(sign(RunSign::none).first.empty());
  const auto [below, square] = sign(RunSign::square);
  ASSERT_EQ(below.size() + square.size(), 2u);
  expect_box(below[0], {200 - 9.2f, 100 - 9.2f}, {200 + 9.2f, 100 + 9.2f});
  expect_box(square[0], {200 - 7.2f, 100 - 7.2f}, {200 + 7.2f, 100 + 7.2f});
  const auto [disc, ring] = sign(RunSign::ring);
  ASSERT_EQ(disc.size() + ring.size(), 2u);
  expect_box(disc[0], {200 - 9.6f, 100 - 9.6f}, {200 + 9.6f, 100 + 9.6f}, 0.8f);
  expect_box(ring[0], {200 - 8.5f, 100 - 8.5f}, {200 + 8.5f, 100 + 8.5f}, 1.2f);
  const auto [rim, triangle] = sign(RunSign::triangle);
  ASSERT_EQ(rim.size() + triangle.size(), 2u);
  expect_box(rim[0], {200 - 11.2f, 100 - 11.2f}, {200 + 11.2f, 100 + 8.96f}, 2);
  expect_box(triangle[0], {200 - 8.64f, 100 - 8.64f}, {200 + 8.64f, 100 + 6.9f}, 2);
}

// 64 px at scale 1: along the time axis, where they move with the data, or along the curve.
TEST_F(APart, PutsSignsAtWholeDistances) {
  const Curve curve{.ink = Ink::hand, .sign = RunSign::square};
  const auto places = [&](const Trace& trace, float emphasis) {
    draw([&](const PlotFrame& in) { draw_run_signs(in, trace, curve, emphasis); });
    std::vector<ImVec2> middles;
    for (const auto& each :
         test::drawn_shapes(colour(ink(palette_, Ink::hand), std::min(1.0f, emphasis)))) {
      middles.push_back(each.middle());
    }
    return middles;
  };
  Trace level;
  TracePen pen(level);
  for (int x = 0; x <= 600; x += 20) pen.put({static_cast<float>(x), 4, 6});
  for (const auto& [first, begins] : {std::pair(0, 128.0f), {100, 28.0f}, {128, 128.0f}}) {
    window_.first_pixel = first;
    const auto at = places(level, first == 0 ? 1.0f : 0.3f);
    ASSERT_EQ(at.size(), first == 100 ? 5u : 4u);
    for (std::size_t i = 0; i < at.size(); ++i) {
      EXPECT_NEAR(at[i].x, 60 + begins + 128 * static_cast<float>(i), 0.1);
      EXPECT_NEAR(at[i].y, 260, 0.1) << "in the middle of the band";
    }
  }
  Trace upwards;
  TracePen up(upwards);
  upwards.wanders = true;
  for (int i = 0; i <= 10; ++i) up.put({50, static_cast<float>(i), static_cast<float>(i)});
  const auto at = places(upwards, 1);
  ASSERT_EQ(at.size(), 3u);
  for (std::size_t i = 0; i < at.size(); ++i) {
    EXPECT_NEAR(at[i].x, 110, 0.1);
    EXPECT_NEAR(at[i].y, 480 - 128 * static_cast<float>(i + 1), 0.1);
  }
}

// Names of thresholds take the right end, above or below, then the left one.
TEST_F(APart, NamesThresholdsBesideTheirDashes) {
  spec_.thresholds = {{5, "one", Ink::energy}, {5, "two", Ink::energy}, {5, "six", Ink::energy}};
  spec_.thresholds.push_back({11, "far", Ink::energy});
  spec_.thresholds.push_back({-1, "low", Ink::energy});
  draw([&](const PlotFrame& in) {
    LabelRoom room(in.area.box());
    draw_thresholds(in, spec_, room);
  });
  const Rgb rgb = ink(palette_, Ink::energy);
  const auto dashes = test::drawn_shapes(colour(rgb, 0.8f));
  ASSERT_EQ(dashes.size(), 3 * 50u);
  for (std::size_t i = 0; i < 50; ++i) {
    const float x = 60 + 12 * static_cast<float>(i);
    expect_box(dashes[i], {x, 260}, {x + 6, 261});
  }
  expect_said("one", {660 - 21 - 10, 246}, rgb);
  expect_said("two", {660 - 21 - 10, 261}, rgb);
  expect_said("six", {70, 246}, rgb);
  EXPECT_FALSE(says("far") || says("low"));
  const auto veils = test::drawn_shapes(colour(palette_.panel, 0.75f));
  ASSERT_EQ(veils.size(), 3u);
  expect_box(veils[0], {623, 246}, {656, 259}, 0.8f);
}

TEST_F(APart, HasNotesWithAFlagAndOtherMarksAsDashes) {
  history_.mark(1, "first");
  history_.mark(1.05, "too close");
  history_.mark(1.07, "apart");
  history_.mark(4, "a note", kNoteMark);
  draw([&](const PlotFrame& in) { draw_mark_lines(in, history_); });
  const auto dashes = test::drawn_shapes(colour(palette_.muted, 0.45f));
  ASSERT_EQ(dashes.size(), 2 * 55u);
  for (std::size_t i = 0; i < 55; ++i) {
    const float y = 40 + 8 * static_cast<float>(i);
    expect_box(dashes[i], {160, y}, {161, y + 4});
    expect_box(dashes[55 + i], {167, y}, {168, y + 4});
  }
  const auto line = test::drawn_shapes(colour(palette_.text, 0.7f));
  const auto flag = test::drawn_shapes(colour(palette_.text));
  ASSERT_EQ(line.size() + flag.size(), 2u);
  expect_box(line[0], {460, 40}, {461, 480});
  expect_box(flag[0], {460, 40}, {476, 40 + 11.2f});
  // A mark beyond the ends is not in sight.
  x_.limits = {1.5, 3.5};
  draw([&](const PlotFrame& in) { draw_mark_lines(in, history_); });
  EXPECT_TRUE(test::drawn_shapes().empty());
}

TEST_F(APart, FindsTheNoteThatIsNearest) {
  history_.mark(2, "note", kNoteMark);
  history_.mark(2.15, "other", kNoteMark);
  history_.mark(4, "no note");
  draw([&](const PlotFrame& in) {
    const auto near = [&](float x) { return note_near(in, history_, {x, 100}).value_or(-1); };
    EXPECT_EQ(near(266), 2);
    EXPECT_EQ(near(269), 2.15);
    EXPECT_EQ(near(251), 2);
    EXPECT_EQ(near(284), 2.15);
    EXPECT_EQ(near(249), -1) << "10 px are as far as it goes";
    EXPECT_EQ(near(286), -1);
    EXPECT_EQ(near(460), -1);
  });
}

// Rows of labels from the bottom up, 13 px each.
class MarkLabels : public APart {
 protected:
  void label(ImVec2 mouse = {0, 0}, std::span<const Trace> traces = {}) {
    draw([&](const PlotFrame& in) {
      LabelRoom room(in.area.box());
      draw_mark_labels(in, spec_, history_, pixels(), traces, mouse, room);
    });
  }
};

TEST_F(MarkLabels, StandBesideTheirLinesInTheLowestFreeRow) {
  history_.mark(2, "aa");
  history_.mark(2.05, "bb");
  history_.mark(3, "p");
  history_.mark(3, "q", kNoteMark);
  history_.mark(5.95, "end");
  label();
  expect_said("aa", {268, 463}, palette_.muted);
  expect_said("bb", {273, 450}, palette_.muted);
  expect_said("p", {368, 463}, palette_.muted);
  expect_said("q", {368, 450}, palette_.text);
  expect_said("end", {655 - 8 - 21, 463}, palette_.muted);
  const auto veils = test::drawn_shapes(colour(palette_.panel, 0.85f));
  ASSERT_EQ(veils.size(), 5u);
  expect_box(veils[0], {262, 463}, {288, 476}, 0.8f);
}

TEST_F(MarkLabels, AreCountedWhereThereAreManyAndAllSaidOfWhatIsPointedAt) {
  for (const char* each : {"one", "two", "six"}) history_.mark(4, each);
  label();
  ASSERT_EQ(texts_.size(), 1u);
  expect_said("one and 2 more", {468, 463}, palette_.muted);
  label({470, 200});
  EXPECT_EQ(texts_.size(), 1u) << "10 px beside it";
  label({466, 20});
  EXPECT_EQ(texts_.size(), 1u) << "above the area";
  label({466, 200});
  expect_said("one", {468, 463}, palette_.muted);
  expect_said("two", {468, 450}, palette_.muted);
  expect_said("six", {468, 437}, palette_.muted);
  EXPECT_EQ(test::drawn_shapes(colour(palette_.panel)).size(), 3u) << "on opaque ground";
  for (const char* each : {"4", "5", "6"}) history_.mark(4, each);
  label({466, 200});
  EXPECT_EQ(texts_.size(), 6u) << "five rows, and one is said over another";
  for (int i = 0; i < 7; ++i) history_.mark(1 + 0.02 * i, "label");
  label();
  EXPECT_EQ(std::ranges::count(texts_, "label", &test::DrawnText::text), 5);
}

TEST_F(MarkLabels, KeepClearOfCurvesAndOfWhatABandSays) {
  history_.mark(2, "aa");
  const auto row_with = [&](float from, float to, float value) {
    std::vector<Trace> traces(1);
    TracePen pen(traces[0]);
    pen.put({from, value, value});
    pen.put({to, value, value});
    label({0, 0}, traces);
    return texts_.at(0).at.y;
  };
  // The lowest row is from 463 to 476: values of 0.09 to 0.39; the label from 208 to 222 px.
  EXPECT_NEAR(row_with(190, 240, 0.2f), 450, 1) << "between two samples";
  EXPECT_NEAR(row_with(190, 212, 0.2f), 450, 1);
  EXPECT_NEAR(row_with(215, 400, 0.2f), 450, 1);
  EXPECT_NEAR(row_with(230, 400, 0.2f), 463, 1);
  EXPECT_NEAR(row_with(100, 200, 0.2f), 463, 1);
  EXPECT_NEAR(row_with(190, 240, 0.6f), 463, 1);
  EXPECT_NEAR(row_with(190, 240, 0.02f), 463, 1);
  std::vector<Trace> everywhere(1);
  TracePen pen(everywhere[0]);
  pen.put({190, -100, 100});
  pen.put({240, -100, 100});
  label({0, 0}, everywhere);
  expect_said("aa", {268, 463}, palette_.muted);
  spec_.bands = {{.channel = 1, .names = {"", "a", "b", "c"}, .key = "said"}};
  history_.mark(4, "in words", "said");
  history_.mark(5, "still", "other");
  label();
  EXPECT_FALSE(says("in words"));
  EXPECT_TRUE(says("still"));
}

}  // namespace
}  // namespace limpid
