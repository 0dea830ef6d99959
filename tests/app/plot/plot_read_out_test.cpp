// Words of a plot on a moment or a stretch of time, at twice the usual scale: bands and their
// names, the selection, playback, the box beside the mouse, values at the right end, and notices.
#include <array>
#include <cmath>

#include "tests/app/plot/a_part.h"

namespace limpid {
namespace {

using test::drawn_shapes;

// A second of 0, then of 1, then of 2, and so on, in channel 1.
class ABandOfAPart : public APart {
 protected:
  ABandOfAPart() {
    history_.clear();
    for (int k = 0; k < 600; ++k) append(std::array{1e-2 * k, std::floor(k / 100.0)});
  }
  void tint() {
    draw([&](const PlotFrame& in) { draw_bands(in, spec_, history_, pixels()); });
  }
  void name() {
    draw([&](const PlotFrame& in) {
      LabelRoom room(in.area.box());
      draw_band_names(in, spec_, history_, pixels(), room);
      for (const test::DrawnText& each : expected_) {
        EXPECT_FALSE(room.has({each.at.x, each.at.y, 5, 5})) << each.text << " has its room";
      }
    });
  }
  // A text that is to be there.
  void expect(const std::string& text, ImVec2 at) {
    test::DrawnText wanted;
    wanted.text = text;
    wanted.at = at;
    expected_.push_back(wanted);
  }
  std::vector<test::DrawnText> expected_;
};

TEST_F(ABandOfAPart, TintsEachStretchByItsNumber) {
  spec_.bands = {{.channel = 1, .names = {"", "low", "mid", "high"}, .tint = 0.6f}};
  tint();
  const auto all = drawn_shapes();
  ASSERT_EQ(all.size(), 3u) << "what is beyond the last name goes on with it";
  for (int i = 0; i < 3; ++i) {
    const test::DrawnShape& each = all[static_cast<std::size_t>(i)];
    const float left = 160 + 100 * static_cast<float>(i);
    expect_box(each, {left, 40}, {i < 2 ? left + 100 : 660, 480});
    EXPECT_EQ(each.colour, colour(palette_.accent, 0.2f * static_cast<float>(i + 1))) << i;
  }
  spec_.bands[0].names = {"usual"};
  tint();
  EXPECT_TRUE(drawn_shapes().empty());
}

TEST_F(ABandOfAPart, HasLawsWithAnEdgeInTheLineOfTheirLane) {
  spec_.bands = {{.channel = 1, .names = {"a", "b", "c", "d", "e", "f"}, .tint = 0.2f}};
  spec_.bands[0].laws = true;
  tint();
  const auto both = drawn_shapes();
  ASSERT_EQ(both.size(), 12u);
  for (int law = 0; law < 6; ++law) {
    const auto i = static_cast<std::size_t>(2 * law);
    const float left = 60 + 100 * static_cast<float>(law);
    expect_box(both[i], {left, 40}, {left + 100, 480});
    expect_box(both[i + 1], {left, 40}, {left + 100, 46});
    EXPECT_EQ(both[i].colour, colour(law_ink(palette_, law), 0.2f));
    EXPECT_EQ(both[i + 1].colour, colour(law_ink(palette_, law)));
  }
  for (const int lane : {0, 2}) {
    spec_.bands[0].lane = lane;
    tint();
    const auto edges = drawn_shapes();
    ASSERT_EQ(edges.size(), 6u);
    const float top = 40 + 7 * static_cast<float>(lane);
    expect_box(edges[1], {160, top}, {260, top + 6});
  }
}

TEST_F(ABandOfAPart, StripesWhatIsNotAsItSeems) {
  spec_.bands = {{.channel = 1, .names = {"", "off"}, .striped = true}};
  tint();
  const auto veil = drawn_shapes(colour(palette_.muted, 0.1f));
  ASSERT_EQ(veil.size(), 1u);
  expect_box(veil[0], {160, 40}, {660, 480});
  const auto stripes = drawn_shapes(colour(palette_.muted, 0.5f));
  // From the first multiple of 14 that reaches the stretch, as each goes 440 px to the right.
  const int first = static_cast<int>(std::floor((160 - 440) / 14.0));
  ASSERT_EQ(stripes.size(), 68u) << "from 14 times -20 to 14 times 47";
  for (std::size_t i = 0; i < stripes.size(); ++i) {
    const float left = 14 * static_cast<float>(first + static_cast<int>(i));
    expect_box(stripes[i], {left, 40}, {left + 440, 480}, 3);
    EXPECT_EQ(stripes[i].clip.x, 160);
    EXPECT_EQ(stripes[i].clip.y, 40);
    EXPECT_EQ(stripes[i].clip.z, 660);
    EXPECT_EQ(stripes[i].clip.w, 480);
  }
}

TEST_F(ABandOfAPart, HasItsNamesInALineBelowTheEdges) {
  spec_.bands = {{.channel = 1, .names = {"usual", "one", "two"}, .laws = true},
                 {.channel = 1, .names = {"", "off"}, .striped = true}};
  expect("usual", {64, 47});
  expect("one", {164, 47});
  expect("two", {264, 47});
  expect("off", {164, 60});
  name();
  for (const test::DrawnText& each : expected_) {
    expect_said(each.text, each.at, each.text == "off" ? palette_.text : palette_.muted);
  }
  EXPECT_EQ(texts_.size(), 4u);
  const auto veils = drawn_shapes(colour(palette_.panel, 0.85f));
  ASSERT_EQ(veils.size(), 4u);
  expect_box(veils[0], {58, 47}, {64 + 35 + 6, 60}, 0.8f);
  // Further lanes have an edge each, and names are below them all.
  spec_.bands[0].lane = 1;
  expected_.clear();
  name();
  expect_said("usual", {64, 54}, palette_.muted);
  expect_said("off", {164, 67}, palette_.text);
  // A band that has nothing to say takes no line.
  spec_.bands = {{.channel = 0, .names = {""}}, spec_.bands[1]};
  name();
  expect_said("off", {164, 47}, palette_.text);
}

TEST_F(APart, TintsASelectionAsFarAsItIsInSight) {
  const auto range = [&](double start, double stop) {
    draw([&](const PlotFrame& in) { draw_range(in, start, stop); });
    return drawn_shapes();
  };
  const auto whole = range(1, 3);
  ASSERT_EQ(whole.size(), 3u);
  expect_box(whole[0], {160, 40}, {360, 480});
  EXPECT_EQ(whole[0].colour, colour(palette_.accent, 0.18f));
  expect_box(whole[1], {160, 40}, {161, 480});
  expect_box(whole[2], {359, 40}, {360, 480});
  EXPECT_EQ(whole[1].colour, colour(palette_.accent));
  expect_box(range(-5, 2).at(0), {60, 40}, {260, 480});
  expect_box(range(4, 50).at(0), {460, 40}, {660, 480});
  EXPECT_TRUE(range(-3, -1).empty());
  EXPECT_TRUE(range(7, 8).empty());
}

TEST_F(APart, HasALineWithAHandleWherePlaybackIs) {
  const auto playback = [&](double time, bool held) {
    draw([&](const PlotFrame& in) { draw_playback(in, time, held); });
    return drawn_shapes();
  };
  const auto here = playback(2, false);
  ASSERT_EQ(here.size(), 2u);
  expect_box(here[0], {259, 40}, {261, 480});
  expect_box(here[1], {250, 40}, {270, 54}, 1.6f);
  EXPECT_EQ(here[0].colour, colour(palette_.accent));
  EXPECT_EQ(here[1].colour, colour(palette_.accent));
  EXPECT_EQ(playback(2, true).at(0).colour, colour(palette_.text));
  expect_box(playback(0, false).at(0), {60, 40}, {62, 480});
  expect_box(playback(6, false).at(0), {658, 40}, {660, 480});
  EXPECT_TRUE(playback(6.1, false).empty());
  EXPECT_TRUE(playback(-0.1, false).empty());
}

TEST_F(APart, HasThreeDotsThatOpenItsMenu) {
  const auto dots = [&](bool pointed_at, float height) {
    draw([&](const PlotFrame& in) { draw_menu_button(in, {{600, 0}, {640, height}}, pointed_at); });
    return drawn_shapes();
  };
  const auto all = dots(false, 30);
  ASSERT_EQ(all.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(all[i].middle().x, 610 + 10 * static_cast<float>(i), 0.1);
    EXPECT_NEAR(all[i].middle().y, 15, 0.1);
    EXPECT_NEAR(all[i].width(), 2 * 3.2f - 1, 0.5);
    EXPECT_EQ(all[i].colour, colour(palette_.muted));
  }
  const auto pointed = dots(true, 30);
  ASSERT_EQ(pointed.size(), 4u);
  expect_box(pointed[0], {600, 0}, {640, 30}, 0.8f);
  EXPECT_EQ(pointed[0].colour, colour(palette_.frame_hovered));
  EXPECT_EQ(pointed[1].colour, colour(palette_.text));
  EXPECT_TRUE(dots(true, 0).empty());
}

TEST_F(APart, SaysANoticeInABoxAtItsBottom) {
  const auto notice = [&](const std::string& text, bool bad) {
    draw([&](const PlotFrame& in) { draw_notice(in, text, bad, 0.5f); });
  };
  notice("Saved", false);
  expect_said("Saved", {330.5f + 12, 419 + 8.4f}, palette_.text);
  const auto box = drawn_shapes(colour(palette_.raised, 0.5f));
  ASSERT_EQ(box.size(), 1u);
  expect_box(box[0], {330.5f, 419}, {389.5f, 448.8f}, 0.8f);
  const auto edge = drawn_shapes(colour(palette_.border, 0.5f));
  ASSERT_EQ(edge.size(), 1u);
  expect_box(edge[0], {330.5f, 419}, {389.5f, 448.8f}, 2);
  notice("Not saved", true);
  EXPECT_EQ(drawn_shapes(colour(palette_.broken, 0.5f)).size(), 1u);
  notice(std::string(200, 'w'), false);
  ASSERT_EQ(texts_.size(), 1u);
  EXPECT_NEAR(texts_[0].at.x, 84, 1);
  EXPECT_LE(texts_[0].max.x, 660 - 24 + 1);
  EXPECT_GT(texts_[0].max.x, 660 - 24 - 14);
}

// A row every 10 ms: 1.5 per second, and 7 all the time.
class ABox : public APart {
 protected:
  ABox() {
    history_.clear();
    for (int k = 0; k <= 600; ++k) history_.append(1e-2 * k, std::array{1.5e-2 * k, 7.0});
    spec_.y.unit = "N";
    spec_.curves = {{.label = "up", .ink = Ink::hand},
                    {.channel = 1, .label = "level", .ink = Ink::contact},
                    {.channel = 1, .label = "hidden", .visible = false}};
  }
  void point_at(double time, ImVec2 near_to = {200, 200}) {
    draw([&](const PlotFrame& in) { draw_read_out(in, spec_, history_, time, near_to); });
  }
  // The box, 161 by 65: names of 35 px and values of 42 with a sample of 20 before them.
  test::DrawnShape box() const {
    const auto all = drawn_shapes(colour(palette_.raised, 0.94f));
    EXPECT_EQ(all.size(), 1u);
    return all.empty() ? test::DrawnShape{} : all[0];
  }
};

TEST_F(ABox, HasTheTimeAndALineForEachCurve) {
  point_at(2);
  expect_box(box(), {280, 167.5f}, {441, 232.5f}, 0.8f);
  const auto rim = drawn_shapes(colour(palette_.border));
  ASSERT_EQ(rim.size(), 1u);
  expect_box(rim[0], {280, 167.5f}, {441, 232.5f}, 2);
  ASSERT_EQ(texts_.size(), 5u);
  expect_said("2.00 s", {294, 177.5f}, palette_.muted);
  expect_said("up", {326, 192.5f}, palette_.text);
  expect_said("3.00 N", {385, 192.5f}, palette_.text);
  expect_said("level", {326, 207.5f}, palette_.text);
  expect_said("7.00 N", {385, 207.5f}, palette_.text);
  const auto up = drawn_shapes(colour(ink(palette_, Ink::hand)));
  const auto level = drawn_shapes(colour(ink(palette_, Ink::contact)));
  ASSERT_EQ(up.size(), 2u) << "a dot on the curve, and a sample in the box";
  ASSERT_EQ(level.size(), 2u);
  EXPECT_NEAR(up[0].middle().x, 260.5f, 0.1);
  EXPECT_NEAR(up[0].middle().y, 480 - 132, 0.1);
  EXPECT_NEAR(up[0].width(), 2 * 5.6f - 1, 0.6);
  EXPECT_NEAR(level[0].middle().y, 480 - 308, 0.1);
  expect_box(up[1], {294, 197}, {314, 201});
  expect_box(level[1], {294, 212}, {314, 216});
  const auto rims = drawn_shapes(colour(palette_.panel));
  ASSERT_EQ(rims.size(), 2u);
  EXPECT_NEAR(rims[0].middle().y, 480 - 132, 0.1);
  EXPECT_NEAR(rims[0].width(), 2 * 8 - 1, 0.6);
  const auto line = drawn_shapes(colour(palette_.text, 0.45f));
  ASSERT_EQ(line.size(), 1u);
  expect_box(line[0], {260, 40}, {261, 480});
}

TEST_F(ABox, StaysWithinTheAreaAndBesideItsMoment) {
  point_at(5);
  expect_box(box(), {560 - 20 - 161, 167.5f}, {540, 232.5f}, 0.8f);
  point_at(4.1);  // up to 651 at the right
  EXPECT_NEAR(box().min.x, 470 + 20, 1.2);
  point_at(2, {200, 0});
  EXPECT_NEAR(box().min.y, 40, 0.8);
  point_at(2, {200, 1000});
  EXPECT_NEAR(box().max.y, 480, 0.8);
  point_at(2, {200, 300});
  EXPECT_NEAR(box().middle().y, 300, 0.1);
  // The box of a plot that is too narrow for it goes over the neighbour.
  outer_ = {{390, 0}, {700, 520}};
  point_at(5);
  EXPECT_NEAR(box().min.x, 390, 0.8);
  point_at(6.1);
  EXPECT_TRUE(drawn_shapes().empty());
  point_at(-0.1);
  EXPECT_TRUE(drawn_shapes().empty());
}

TEST_F(ABox, HasNoDotOfAValueThatIsNotInSight) {
  y_.limits = {0, 5};
  point_at(2);
  EXPECT_EQ(drawn_shapes(colour(ink(palette_, Ink::hand))).size(), 2u);
  EXPECT_EQ(drawn_shapes(colour(ink(palette_, Ink::contact))).size(), 1u);
  EXPECT_TRUE(says("7.000 N")) << "5 / 1000 are the finest step";
  y_.limits = {4, 9};
  point_at(2);
  EXPECT_EQ(drawn_shapes(colour(ink(palette_, Ink::hand))).size(), 1u);
}

TEST_F(ABox, SaysWhichLawMadeAPartOfAnotherOne) {
  history_.clear();
  for (int k = 0; k <= 600; ++k) {
    history_.append(1e-2 * k, std::array{3.0, k < 300 ? 0.0 : 2.0});
  }
  spec_.curves = {{.label = "one", .law = 2, .law_channel = 1}};
  point_at(1);
  EXPECT_TRUE(says("one, here standard"));
  EXPECT_EQ(drawn_shapes(colour(law_ink(palette_, 0))).size(), 2u);
  point_at(4);
  EXPECT_TRUE(says("one"));
  EXPECT_EQ(drawn_shapes(colour(law_ink(palette_, 2))).size(), 2u);
}

TEST_F(ABox, WritesLogarithmsAndSmallValuesShortly) {
  y_ = AxisMap{{-1, 1}, true};
  point_at(2);
  EXPECT_TRUE(says("3.00 N"));
  y_ = AxisMap{{0, 0.02}};
  history_.clear();
  for (int k = 0; k <= 600; ++k) history_.append(1e-2 * k, std::array{0.0123, -0.004});
  point_at(2);
  const auto said = [&](const std::string& begins) {
    return std::ranges::any_of(texts_, [&](const test::DrawnText& each) {
      return each.text.starts_with(begins) && each.text.find("10") != std::string::npos &&
             each.text.ends_with(" N");
    });
  };
  EXPECT_TRUE(said("12.30")) << "thousandths, times ten to the minus three";
  EXPECT_TRUE(said("?4.00"));
}

// The nearest pair within 30 px at scale 1.
TEST_F(ABox, FindsTheMomentOfAPair) {
  spec_.kind = PlotKind::cross;
  spec_.curves = {{.channel = 0, .across = 1, .label = "pair"}};
  x_.limits = {4, 10};  // all pairs have 7 across: 360 px
  draw([&](const PlotFrame& in) {
    const auto near = [&](ImVec2 at) { return time_near(in, spec_, history_, at).value_or(-1); };
    EXPECT_NEAR(near({360, 480 - 132}), 2, 1e-6);
    EXPECT_NEAR(near({360 + 59, 480 - 132}), 2, 1e-6);
    EXPECT_NEAR(near({360 - 59, 480 - 66}), 1, 1e-6);
    EXPECT_EQ(near({360 + 61, 480 - 132}), -1);
    EXPECT_EQ(near({360, 480 - 396 - 61}), -1);
    spec_.curves[0].visible = false;
    EXPECT_EQ(near({360, 480 - 132}), -1);
    spec_.curves[0].visible = true;
  });
  draw([&](const PlotFrame& in) { draw_present(in, spec_, history_, 2); });
  const auto dots = drawn_shapes();
  ASSERT_EQ(dots.size(), 2u) << "a dot on its rim";
  EXPECT_NEAR(dots[1].middle().x, 360, 0.1);
  EXPECT_NEAR(dots[1].middle().y, 480 - 132, 0.1);
  draw([&](const PlotFrame& in) { draw_present(in, spec_, History({.channels = 2}), 2); });
  EXPECT_TRUE(drawn_shapes().empty());
}

TEST_F(ABox, WritesValuesBesideTheRightEndApartFromEachOther) {
  outer_.max.x = 760;
  const auto write = [&](double first, double second) {
    history_.clear();
    history_.append(0, std::array{first, second});
    draw([&](const PlotFrame& in) { draw_end_labels(in, spec_, history_, 3); });
  };
  const Rgb one = ink(palette_, Ink::hand), other = ink(palette_, Ink::contact);
  write(5, 2);
  EXPECT_EQ(texts_.size(), 2u) << "none of a hidden curve";
  expect_said("5.00", {670, 260 - 6.5f}, one);
  expect_said("2.00", {670, 392 - 6.5f}, other);
  write(5, 5.1);
  expect_said("5.10", {670, 255.6f - 6.5f}, other);
  expect_said("5.00", {670, 255.6f + 6.5f}, one);
  write(0, 0.1);
  expect_said("0", {670, 467}, one);
  expect_said("0.10", {670, 454}, other);
  write(10, 9.9);
  expect_said("10.00", {670, 40}, one);
  expect_said("9.90", {670, 53}, other);
  write(std::nan(""), 9);
  EXPECT_EQ(texts_.size(), 1u);
  outer_.max.x = 700;
  write(5, 2);
  EXPECT_TRUE(texts_.empty()) << "47 px are needed";
}

TEST_F(APart, NeedsRoomForSixLettersAndAGapBesideItsEnd) {
  ImGui::GetIO().FontGlobalScale = 2 * 16 / 13.0f;
  frame([] {});
  frame([] { EXPECT_NEAR(end_label_width(), 6 * 7 + 2 * 6, 0.1); });
}

}  // namespace
}  // namespace limpid
