#include "app/desktop/panels/magnifier.h"

#include <gtest/gtest.h>

#include "app/desktop/base/picture_signs.h"

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

}  // namespace
}  // namespace limpid
