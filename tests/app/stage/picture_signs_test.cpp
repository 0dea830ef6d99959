// Signs over the picture: their words, their places and what they leave free.
#include "app/stage/picture_signs.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "app/style/palette.h"
#include "app/style/theme.h"
#include "core/coupling/laws.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/drawn_ink.h"
#include "tests/support/drawn_text.h"

namespace limpid {
namespace {

class SignsOfAPicture : public ImGuiFrames {
 protected:
  SignsOfAPicture() {
    apply_theme(Theme::dark, 1);
    frame([] {});  // the font is there from the first frame on
    camera_.resize(400, 300);
    camera_.look(Camera::View::side);
    camera_.frame(Bounds(Vec3(-0.2, -0.1, -0.15), Vec3(0.2, 0.1, 0.15)));
    camera_.finish();
    view_.device.links = view_.proxy.links = {Pose::Identity()};
  }
  // Draws and reads; the words that are seen.
  std::vector<test::DrawnText> draw(const std::function<void(ImDrawList&)>& what) {
    frame([&] { what(*ImGui::GetBackgroundDrawList()); });
    return test::drawn_texts();
  }
  ImVec2 seen(const Vec3& point) const { return in_window(picture_, *camera_.project(point)); }
  // Tells whether a stroke of this colour goes over a place, give or take a pixel.
  static bool has(ImVec2 at, ImU32 wanted) {
    for (int i = 0; i < 81; ++i) {
      const ImVec2 there{at.x + 0.23f * static_cast<float>(i % 9 - 4),
                         at.y + 0.23f * static_cast<float>(i / 9 - 4)};
      if (test::inked(there, [&](ImU32 c) { return c == wanted; })) return true;
    }
    return false;
  }
  static bool has(ImVec2 at, Rgb wanted) { return has(at, colour(wanted)); }
  static Rgb hand() { return ink(current_palette(), Ink::hand); }
  float em() const { return font(Face::small)->FontSize; }

  Camera camera_;
  ViewState view_;
  const ScreenRect picture_{{100, 50}, {500, 350}};
};

TEST_F(SignsOfAPicture, SayAGapAboveAndRightOfTheTips) {
  view_.device.tip = Vec3(0, 0, 0.002);
  const auto texts = draw([&](ImDrawList& list) { draw_gap(view_, camera_, {picture_}, list); });
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_EQ(texts[0].text, "gap 2.00 mm");
  const ImVec2 tips = seen(Vec3(0, 0, 0.001));
  EXPECT_GT(texts[0].min.x, tips.x + em());
  EXPECT_LT(texts[0].min.x, tips.x + 3 * em());
  EXPECT_LT(texts[0].max.y, tips.y);
  EXPECT_GT(texts[0].min.y, tips.y - 3 * em());
}

TEST_F(SignsOfAPicture, KeepAGapWithinThePictureAndOutOfTheLens) {
  view_.device.tip = view_.proxy.tip = Vec3(0.2, 0, 0);
  view_.proxy.tip.z() = 0.002;
  const auto gap = [&](const GapPlace& at) {
    return draw([&](ImDrawList& list) { draw_gap(view_, camera_, at, list); }).at(0);
  };
  const ImVec2 tips = seen(view_.device.tip);
  EXPECT_LT(gap({picture_}).max.x, picture_.max.x - em());
  view_.device.tip.x() = view_.proxy.tip.x() = 0;
  const test::DrawnText right = gap({picture_});
  const test::DrawnText left = gap({picture_, ScreenRect{right.min, right.max}});
  EXPECT_LT(left.max.x, seen(Vec3::Zero()).x) << "the lens is right of the tips";
  EXPECT_LT(left.max.x, right.min.x);
  const test::DrawnText far = gap({picture_, ScreenRect{{490, 300}, {500, 350}}});
  EXPECT_EQ(far.min.x, right.min.x) << "a lens elsewhere changes nothing";
  EXPECT_GT(tips.x, 400);
}

TEST_F(SignsOfAPicture, SayNoGapOfAnArmThatIsNotThereOrOfNone) {
  view_.device.tip = Vec3(0, 0, 0.002);
  for (ArmPose* arm : {&view_.device, &view_.proxy}) {
    const auto links = std::exchange(arm->links, {});
    EXPECT_TRUE(
        draw([&](ImDrawList& list) { draw_gap(view_, camera_, {picture_}, list); }).empty());
    arm->links = links;
  }
  view_.device.tip = view_.proxy.tip;
  EXPECT_TRUE(draw([&](ImDrawList& list) { draw_gap(view_, camera_, {picture_}, list); }).empty());
}

TEST_F(SignsOfAPicture, SayTheGapsOfFurtherRunsBelowEachOther) {
  view_.device.tip = Vec3(0, 0, 0.002);
  view_.beside.resize(2);
  view_.beside[0].device.tip = Vec3(0, 0, 0.003);
  view_.beside[1].device.tip = Vec3(0, 0, 0.004);
  const auto texts = draw([&](ImDrawList& list) { draw_gap(view_, camera_, {picture_}, list); });
  ASSERT_EQ(texts.size(), 3u);
  EXPECT_EQ(texts[0].text, "gap 2.00 mm");
  EXPECT_EQ(texts[1].text, "gap 3.00 mm");
  EXPECT_EQ(texts[2].text, "gap 4.00 mm");
  EXPECT_LT(texts[0].max.y, seen(Vec3::Zero()).y);
  EXPECT_GT(texts[1].min.y, seen(Vec3::Zero()).y);
  EXPECT_GT(texts[2].min.y, texts[1].max.y);
}

TEST_F(SignsOfAPicture, SayWhichRunAGapIsOf) {
  view_.device.tip = Vec3(0, 0, 0.002);
  view_.beside.resize(2);
  view_.beside[0].device.tip = Vec3(0, 0, 0.003);
  view_.beside[1].device.tip = Vec3(0, 0, 0.004);
  const RunNames names{{"one", "two", "three"}};
  const auto texts =
      draw([&](ImDrawList& list) { draw_gap(view_, camera_, {picture_}, list, names); });
  ASSERT_EQ(texts.size(), 3u);
  EXPECT_EQ(texts[0].text, "one: gap 2.00 mm");
  EXPECT_EQ(texts[1].text, "two: gap 3.00 mm");
  EXPECT_EQ(texts[2].text, "three: gap 4.00 mm");
}

TEST_F(SignsOfAPicture, NameARunAboveItsPartWithASampleOfItsCurves) {
  const auto name = [&](const RunNames& names, std::size_t run) {
    return draw([&](ImDrawList& list) { draw_run_name(names, run, picture_, list); }).at(0);
  };
  const test::DrawnText plain = name({{"one", "two"}}, 1);
  EXPECT_EQ(plain.text, "two");
  EXPECT_NEAR(plain.middle().x, 300, 3);
  EXPECT_GT(plain.min.y, picture_.min.y);
  EXPECT_LT(plain.max.y, picture_.min.y + 40);
  const int law = static_cast<int>(CouplingKind::predictive);
  const test::DrawnText coloured = name({{"one", "two"}, true, {0, law}}, 1);
  EXPECT_GT(coloured.min.x, plain.min.x) << "the sample is before it";
  EXPECT_EQ(coloured.min.y, plain.min.y);
  const ImVec2 sample{coloured.min.x - 0.4f * em(), coloured.middle().y};
  bool seen = false;
  for (int i = 0; i < 30 && !seen; ++i) {
    seen = has({sample.x - static_cast<float>(i), sample.y}, law_ink(current_palette(), law));
  }
  EXPECT_TRUE(seen) << "in the law's colour";
}

TEST_F(SignsOfAPicture, DrawAPullAsALineWithItsForce) {
  const Vec3 from(-0.1, 0, 0), to(0.1, 0, 0.05);
  EXPECT_TRUE(
      draw([&](ImDrawList& list) { draw_pull(view_, 2, camera_, picture_, list); }).empty());
  view_.pull = {from, to};
  const auto texts =
      draw([&](ImDrawList& list) { draw_pull(view_, 1.25, camera_, picture_, list); });
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_THAT(texts[0].text, testing::AnyOf("1.2 N", "1.3 N"));
  EXPECT_EQ(texts[0].colour, colour(hand()));
  const ImVec2 end = seen(to);
  EXPECT_LT(texts[0].max.x, end.x);
  EXPECT_GT(texts[0].min.y, end.y);
  EXPECT_LT(texts[0].min.y, end.y + 2 * em());
  const ImVec2 middle{(seen(from).x + end.x) / 2, (seen(from).y + end.y) / 2};
  EXPECT_TRUE(has(middle, hand()));
  EXPECT_FALSE(has({middle.x, middle.y + 20}, hand()));
  EXPECT_TRUE(has({seen(from).x - 0.3f * em(), seen(from).y}, hand()))
      << "a small ring where it is";
  EXPECT_TRUE(has({end.x + 0.6f * em(), end.y}, hand())) << "a larger one where it is to come";
  EXPECT_TRUE(
      draw([&](ImDrawList& list) { draw_pull(view_, 0.049, camera_, picture_, list); }).empty());
}

TEST_F(SignsOfAPicture, DrawALineToWhatIsBelowTheTip) {
  view_.device.tip = Vec3(0, 0, 0.1);
  const auto line = [&](double below) {
    draw([&](ImDrawList& list) { draw_drop(view_, below, camera_, picture_, list); });
    const ImVec2 middle = seen(view_.device.tip - below / 2 * Vec3::UnitZ());
    return has(middle, colour(hand(), 0.8f));
  };
  EXPECT_TRUE(line(0.15));
  const ImVec2 foot = seen(Vec3(0, 0, -0.05));
  EXPECT_TRUE(has({foot.x + 0.3f * em(), foot.y}, hand())) << "a ring where it meets something";
  EXPECT_FALSE(line(0.0039)) << "it is nearly there";
  view_.device.links.clear();
  EXPECT_FALSE(line(0.15));
}

TEST_F(SignsOfAPicture, RingTheProxysTipWhileItsMagnetIsOn) {
  view_.proxy.tip = Vec3(0.05, 0, 0);
  const auto width = [&] {
    draw([&](ImDrawList& list) { draw_magnet(view_, camera_, picture_, list); });
    const ImVec2 tip = seen(view_.proxy.tip);
    int count = 0;
    for (int i = -40; i <= 40; ++i) {
      const ImVec2 at{tip.x + em() + 0.1f * static_cast<float>(i), tip.y + 0.37f};
      count += test::inked(at, [](ImU32 c) { return c == colour(current_palette().accent); });
    }
    return count;
  };
  EXPECT_EQ(width(), 0);
  view_.magnet = true;
  const int alone = width();
  EXPECT_GT(alone, 0);
  view_.magnet_holds = true;
  EXPECT_GT(width(), alone + 5) << "thick while it holds something";
  view_.proxy.links.clear();
  EXPECT_EQ(width(), 0);
}

TEST_F(SignsOfAPicture, RingTheDevicesTipWithTheForceOfTheHandThatHoldsIt) {
  view_.device.tip = Vec3(0.05, 0, 0);
  view_.hand_force = Vec3(3, 0, 4);
  const auto grasp = [&] {
    return draw([&](ImDrawList& list) { draw_grasp(view_, camera_, picture_, list); });
  };
  EXPECT_TRUE(grasp().empty()) << "it only would";
  const ImVec2 tip = seen(view_.device.tip);
  EXPECT_TRUE(has({tip.x + 1.3f * em(), tip.y}, hand()));
  view_.hand_grips = true;
  const auto texts = grasp();
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_EQ(texts[0].text, "5.0 N");
  view_.device.links.clear();
  EXPECT_TRUE(grasp().empty());
  EXPECT_FALSE(has({tip.x + 1.3f * em(), tip.y}, hand()));
}

// The hand is near an edge of the picture, in a corner, or beyond.
TEST_F(SignsOfAPicture, SayAForceWholeWithinThePictureAndBesideTheHand) {
  view_.hand_force = Vec3(3, 0, 4);
  view_.hand_grips = true;
  for (const double x : {-60.0, 2.0, 200.0, 398.0, 460.0}) {
    for (const double y : {-60.0, 2.0, 150.0, 298.0, 360.0}) {
      SCOPED_TRACE(testing::Message() << x << ", " << y);
      const Vec3 hand = camera_.plane_drag({x, y}, Vec3::Zero());
      view_.device.tip = hand;
      view_.pull = {Vec3::Zero(), hand};
      const auto texts = draw([&](ImDrawList& list) {
        draw_grasp(view_, camera_, picture_, list);
        draw_pull(view_, 5, camera_, picture_, list);
      });
      ASSERT_EQ(texts.size(), 2u);
      for (const test::DrawnText& each : texts) {
        EXPECT_EQ(each.text, "5.0 N");
        EXPECT_TRUE(picture_.contains(each.min) && picture_.contains(each.max))
            << each.min.x << ", " << each.min.y << " to " << each.max.x << ", " << each.max.y;
        const ImVec2 at = seen(hand);
        const bool over = each.max.x > at.x - em() && each.min.x < at.x + em() &&
                          each.max.y > at.y - em() && each.min.y < at.y + em();
        EXPECT_FALSE(over);
      }
    }
  }
}

TEST_F(SignsOfAPicture, KeepTipsAndWhatIsPulledFree) {
  view_.device.tip = Vec3(0.1, 0, 0);
  view_.proxy.tip = Vec3(-0.1, 0, 0);
  const auto kept = [&] {
    Crowd crowd;
    keep_acted_on_free(view_, camera_, picture_, crowd);
    return crowd.kept_free;
  };
  ASSERT_EQ(kept().size(), 2u);
  for (const auto& [i, point] : {std::pair(0u, view_.device.tip), {1u, view_.proxy.tip}}) {
    const ScreenRect box = kept()[i];
    EXPECT_NEAR((box.min.x + box.max.x) / 2, seen(point).x, 0.1);
    EXPECT_NEAR((box.min.y + box.max.y) / 2, seen(point).y, 0.1);
    EXPECT_GT(box.width(), 2 * em());
    EXPECT_GT(box.height(), 2 * em());
  }
  view_.pull = {Vec3(0, 0, 0.1), Vec3(0, 0, -0.1)};
  EXPECT_EQ(kept().size(), 4u);
  view_.device.links.clear();
  EXPECT_EQ(kept().size(), 3u);
  view_.proxy.tip.x() = std::nan("");
  EXPECT_EQ(kept().size(), 2u);
}

TEST_F(SignsOfAPicture, WarnAtTheTopOfAPictureOrBelowTheNamesOfItsRuns) {
  const auto sign = [&](const char* words, bool below) {
    return draw([&](ImDrawList& list) { draw_sign(words, picture_, below, list); });
  };
  EXPECT_TRUE(sign("", false).empty());
  const auto top = sign("force off", false), below = sign("force off", true);
  ASSERT_EQ(top.size(), 1u);
  ASSERT_EQ(below.size(), 1u);
  EXPECT_EQ(top[0].text, "force off");
  EXPECT_NEAR(top[0].middle().x, 300, 2) << "in the middle";
  EXPECT_GT(top[0].min.y, picture_.min.y);
  EXPECT_LT(top[0].max.y, picture_.min.y + 60);
  EXPECT_GT(below[0].min.y, top[0].max.y) << "a line is free for the names";
  EXPECT_TRUE(has({below[0].min.x - 4, below[0].middle().y}, current_palette().accent));
}

TEST_F(SignsOfAPicture, TellASentenceAtTheBottomInAsManyLinesAsItNeeds) {
  const auto tell = [&](const std::string& told) {
    return draw([&](ImDrawList& list) { draw_told(told, picture_, list); });
  };
  EXPECT_TRUE(tell("").empty());
  const std::string one = "The hand lets go.";
  const auto single = tell(one);
  ASSERT_EQ(single.size(), 1u);
  EXPECT_EQ(single[0].text, one);
  EXPECT_NEAR(single[0].middle().x, 300, 5);
  EXPECT_LT(single[0].max.y, picture_.max.y);
  EXPECT_GT(single[0].min.y, picture_.max.y - 60);
  const std::string many =
      "The arm stays where it is, as the hand lets go and no force is left that would move it away "
      "from the wall that it has touched.";
  std::string all;
  float below = 0;
  const auto lines = tell(many);
  EXPECT_GE(lines.size(), 2u);
  for (const test::DrawnText& line : lines) {
    all += (all.empty() ? "" : " ") + line.text;
    EXPECT_LT(line.max.x - line.min.x, 0.87f * picture_.width());
    EXPECT_NEAR(line.middle().x, 300, 5);
    EXPECT_GT(line.min.y, below);
    below = line.max.y;
  }
  EXPECT_EQ(all, many) << "each word once";
  EXPECT_LT(below, picture_.max.y);
  EXPECT_NEAR(lines.back().max.y, single[0].max.y, 6) << "the last line stays";
  const std::string wide(200, 'w');
  std::string cut;
  for (const test::DrawnText& line : tell(wide)) cut += line.text;
  EXPECT_EQ(cut, wide);
}

TEST(PartsOfAPicture, ShareItsWidth) {
  const ScreenRect whole{{100, 50}, {500, 350}};
  for (const std::size_t runs : {1u, 2u, 3u}) {
    float last = whole.min.x;
    for (std::size_t run = 0; run < runs; ++run) {
      const ScreenRect part = part_of(whole, run, runs);
      EXPECT_EQ(part.min.y, whole.min.y);
      EXPECT_EQ(part.max.y, whole.max.y);
      EXPECT_EQ(part.min.x, run == 0 ? last : last + 2) << "two pixels between";
      EXPECT_NEAR(part.width(), 400.0 / static_cast<double>(runs), 3);
      last = part.max.x;
    }
    EXPECT_EQ(last, whole.max.x);
  }
}

TEST(PartsOfAPicture, CountPixelsFromTheirCorner) {
  const ImVec2 at = in_window({{100, 50}, {500, 350}}, {3, 7});
  EXPECT_EQ(at.x, 103);
  EXPECT_EQ(at.y, 57);
}

}  // namespace
}  // namespace limpid
