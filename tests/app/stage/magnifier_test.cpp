#include "app/stage/magnifier.h"

#include <gtest/gtest.h>

#include <array>

#include "app/stage/picture_signs.h"
#include "tests/app/plot/imgui_frames.h"

namespace limpid {
namespace {

ViewState apart_by(double gap) {
  ViewState state;
  state.device.links = state.proxy.links = {Pose::Identity()};
  state.device.tip = Vec3(0, 0, gap);
  return state;
}

TEST(Magnifier, SaysTheGapInMillimetres) {
  EXPECT_EQ(gap_text(0.000423), "gap 0.42 mm");
  EXPECT_EQ(gap_text(0.0158), "gap 15.8 mm");
  EXPECT_EQ(gap_text(0), "");
  EXPECT_EQ(gap_text(std::numeric_limits<double>::quiet_NaN()), "");
}

TEST(Magnifier, IsShownWhileGapOrContactIsSmallInThePicture) {
  const Camera camera;
  const double pixel = camera.meters_per_pixel(Vec3::Zero());
  EXPECT_FALSE(worth_magnifying(apart_by(0), camera));
  EXPECT_TRUE(worth_magnifying(apart_by(5 * pixel), camera));
  EXPECT_FALSE(worth_magnifying(apart_by(200 * pixel), camera));
  ViewState touching = apart_by(0);
  touching.contacts.push_back({Vec3::Zero(), Vec3::UnitZ()});
  EXPECT_TRUE(worth_magnifying(touching, camera));
  EXPECT_FALSE(worth_magnifying(ViewState{}, camera));
}

using Lens = ImGuiFrames;

bool overlap(ScreenRect a, ScreenRect b) {
  return a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y;
}

// Holds for all places of the tips, and any height of the words at the view's top.
TEST_F(Lens, HidesNeitherTheTipsNorWordsAndStaysInTheView) {
  frame([&] {
    for (const ScreenRect view : {ScreenRect{{300, 24}, {990, 482}}, {{300, 24}, {900, 365}}}) {
      for (const float words : {0.0f, 60.0f, 90.0f, 150.0f}) {
        const ScreenRect said{view.min, {view.max.x, view.min.y + words}};
        for (float x = view.min.x; x < view.max.x; x += 15) {
          for (float y = view.min.y + words; y < view.max.y; y += 15) {
            FreePlace corner;
            const ScreenRect tips{{x - 30, y - 30}, {x + 30, y + 30}};
            const auto lens = corner.choose(lens_corners(view, words), {{tips}, {}});
            ASSERT_TRUE(lens);
            EXPECT_FALSE(lens->contains({x, y})) << x << ", " << y << " below " << words;
            EXPECT_FALSE(overlap(*lens, said));
            EXPECT_TRUE(view.contains(lens->min) && view.contains(lens->max));
          }
        }
      }
    }
    EXPECT_TRUE(lens_corners({{0, 0}, {120, 90}}, 0).empty()) << "too small to show anything";
  });
}

const ScreenRect kOnePlace{{0, 0}, {100, 100}}, kOtherPlace{{200, 0}, {300, 100}};

TEST(FreePlace, TakesTheFirstThatCoversNothing) {
  const std::array places{kOnePlace, kOtherPlace};
  FreePlace place;
  EXPECT_EQ(place.choose(places, {})->min.x, 0);
  EXPECT_EQ(place.choose(places, {{{{40, 40}, {60, 60}}}, {}})->min.x, 200) << "a tip";
  EXPECT_FALSE(FreePlace().choose({}, {}));
}

// Objects count less than tips, and a place is not left for a little.
TEST(FreePlace, MovesOnlyForSomethingThatCounts) {
  const std::array places{kOnePlace, kOtherPlace};
  FreePlace place;
  const ScreenRect small{{90, 90}, {110, 110}}, large{{0, 0}, {100, 50}};
  EXPECT_EQ(place.choose(places, {{}, {small}})->min.x, 200);
  EXPECT_EQ(place.choose(places, {})->min.x, 200) << "it stays where it covers nothing";
  EXPECT_EQ(place.choose(places, {{}, {{{200, 0}, {209, 100}}}})->min.x, 200) << "for so little";
  EXPECT_EQ(place.choose(places, {{}, {{{200, 0}, {220, 100}}}})->min.x, 0);
  EXPECT_EQ(place.choose(places, {{{{250, 50}, {260, 60}}}, {large}})->min.x, 0)
      << "rather an object than a tip";
}

}  // namespace
}  // namespace limpid
