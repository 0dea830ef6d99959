// Identification of the scale of a device's torques by a load of known mass.
#include "devices/identify/torque_scale.h"

#include <gtest/gtest.h>

#include "devices/identify/unlike_device.h"
#include "tests/devices/identify/moved.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

const Vec3 kGravity(0, 0, -9.81);

struct Motions {
  ArmDescription truth;
  MotionRecord bare, with_load;
};

Motions motions_of(const ArmDescription& file, const ArmDescription& truth, const Unlikeness& bench,
                   double mass) {
  UnlikeDevice device(truth, bench), heavier(loaded(truth, mass), bench);
  return {truth, test::moved(device, file), test::moved(heavier, file)};
}

void expect_found_by_load(const ArmDescription& file, Unlikeness bench, double mass,
                          unsigned seed) {
  SCOPED_TRACE(testing::Message() << file.name << ", " << bench.torque_scale);
  const Motions m = motions_of(file, unlike(file, seed, 0.02), bench, mass);
  const FitSettings settings{.gravity = bench.gravity};
  const Identified told = identify(file, m.bare, settings);
  const Found scale = torque_scale_by_load(told, m.bare, m.with_load, mass, settings);
  EXPECT_NEAR(scale.value, bench.torque_scale, 0.03 * bench.torque_scale);
  EXPECT_LT(scale.deviation, 0.03 * scale.value);
}

TEST(TorqueScale, IsFoundByALoadAtTheTip) {
  const ArmDescription omni = test::omni();
  expect_found_by_load(omni,
                       {.gravity = kGravity, .encoder_step = 3e-5, .delay = 2, .torque_scale = 0.8},
                       0.05, 601);
  expect_found_by_load(omni,
                       {.gravity = kGravity, .encoder_step = 1e-4, .delay = 1, .torque_scale = 1.3},
                       0.05, 602);
  const ArmDescription paddle = read_urdf(test::assets_dir() / "devices/paddle.urdf");
  // An upright axis sees nothing of the load's weight, but its inertia.
  expect_found_by_load(paddle, {.encoder_step = 1e-4, .delay = 1, .torque_scale = 1.2}, 0.02, 603);
}

TEST(TorqueScale, IsFoundByTheFilesMassesWhereTheyAreRight) {
  const ArmDescription file = test::omni();
  const Unlikeness bench{
      .gravity = kGravity, .encoder_step = 3e-5, .delay = 2, .torque_scale = 0.75};
  const Motions m = motions_of(file, file, bench, 0.05);
  const FitSettings settings{.gravity = kGravity};
  const Identified told = identify(file, m.bare, settings);
  EXPECT_NEAR(torque_scale_by_masses(file, told, m.bare, settings).value, 0.75, 0.02 * 0.75);
}

TEST(TorqueScale, IsNotGuessedFromALoadThatSaysNothing) {
  const ArmDescription file = test::omni();
  const Unlikeness bench{.gravity = kGravity, .encoder_step = 1e-3, .delay = 2};
  const Motions m = motions_of(file, unlike(file, 604, 0.02), bench, 0);
  const FitSettings settings{.gravity = kGravity};
  const Identified told = identify(file, m.bare, settings);
  EXPECT_THROW(torque_scale_by_load(told, m.bare, m.with_load, 1e-4, settings),
               std::invalid_argument);
}

}  // namespace
}  // namespace limpid
