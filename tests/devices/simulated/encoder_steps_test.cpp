// Walls through encoders with steps, on models of devices that people own: how quiet they are, what
// is felt of them, and the energy that the hand is given.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/support/built_in.h"
#include "tests/support/press.h"

namespace limpid {
namespace {

using test::Press;
using test::Pressed;

struct DeviceToPress {
  const char* file;
  double step;   // of its encoders; 0.1 m of a slide are 1 rad [rad]
  double press;  // of the hand on a wall [N]
  double friction = kFromArm;
};
constexpr DeviceToPress kTouch{"touch.urdf", 4.19e-4, 1.5},
    kSmoothTouch{"touch.urdf", 4.19e-4, 1.5, 0};
constexpr DeviceToPress kOmega{"omega.urdf", 1e-4, 4}, kFalcon{"falcon.urdf", 3.84e-4, 4};
constexpr DeviceToPress kInverse3{"inverse3.urdf", 1e-4, 4, 0.02};  // friction assumed

// Grips, in which the hand's mass does or does not move with the tip.
struct Grip {
  double stiffness, damping, mass;  // [N/m, N s/m, kg]
};
constexpr Grip kGrips[] = {{300, 2, 0},   {1000, 2, 0},   {3000, 5, 0},
                           {300, 2, 0.1}, {1000, 2, 0.2}, {3000, 5, 0.1}};
constexpr Grip kUndamped[] = {{300, 0, 0},   {1000, 0, 0},   {3000, 0, 0},
                              {300, 0, 0.1}, {1000, 0, 0.2}, {3000, 0, 0.1}};

// Worst of all grips.
struct Worst {
  double held = 0, moving = 0;              // [mm/s]
  double held_force = 0, moving_force = 0;  // [N]
  double felt = 0;                          // mean over the grips [-]
  double given = 0;                         // [mJ]
  bool diverged = false;
};

using Change = std::function<void(Parameters&)>;

Worst worst_of(const DeviceToPress& device, double wall, std::span<const Grip> grips, int delay = 0,
               const Change& change = {}) {
  const ArmDescription arm = read_urdf(test::assets_dir() / "devices" / device.file);
  const RigStart start = rest_at(arm, Vec3(0.2, 0, -0.04 + Press::kAbove));
  Worst worst;
  for (const Grip& grip : grips) {
    Parameters p;
    p.kind = CouplingKind::predictive;
    p.encoder_step = device.step;
    p.device_delay = p.delay = delay;
    p.hand_stiffness = grip.stiffness;
    p.hand_damping = grip.damping;
    p.hand_mass_at_tip = grip.mass;
    p.friction = device.friction;
    p.torque_limit = 100;  // strong motors
    if (change) change(p);
    const Pressed it = Press{.wall = wall, .force = device.press}.on(arm, start, Vec3::UnitZ(), p);
    worst.diverged = worst.diverged || it.diverged;
    worst.held = std::max(worst.held, 1e3 * it.held_speed);
    worst.moving = std::max(worst.moving, 1e3 * it.moving_speed);
    worst.held_force = std::max(worst.held_force, it.held_force);
    worst.moving_force = std::max(worst.moving_force, it.moving_force);
    worst.felt += it.felt / static_cast<double>(grips.size());
    worst.given = std::max(worst.given, 1e3 * it.given);
  }
  return worst;
}

struct Bounds {
  double held, moving;  // [mm/s]
  double soft, stiff;   // of what is felt [-]
  double force = 0.08;  // of the press [-]
  double given = 0.05;  // [mJ]
};

void expect_quiet(const DeviceToPress& device, double wall, int delay, const Bounds& bounds,
                  const Change& change = {}) {
  SCOPED_TRACE(testing::Message() << device.file << ", " << wall << " N/m, " << delay << " ms");
  const Worst worst = worst_of(device, wall, kGrips, delay, change);
  EXPECT_FALSE(worst.diverged);
  EXPECT_LE(worst.held, bounds.held);
  EXPECT_LE(worst.moving, bounds.moving);
  EXPECT_LE(worst.held_force, bounds.force * device.press);
  EXPECT_LE(worst.moving_force, bounds.force * device.press);
  EXPECT_GE(worst.felt, bounds.soft);
  EXPECT_LE(worst.felt, bounds.stiff);
  EXPECT_LE(worst.given, bounds.given);
  const Worst undamped = worst_of(device, wall, kUndamped, delay, change);
  EXPECT_FALSE(undamped.diverged);
  EXPECT_LE(undamped.given, bounds.given) << "in hands that do not damp";
}

constexpr Bounds kQuiet{1, 3, 0.95, 1.05};

TEST(EncoderSteps, OfATouchAreQuietOnWallsOfAThousandNewtonsPerMetreAndMore) {
  for (int delay = 0; delay <= 2; ++delay) {
    expect_quiet(kTouch, 1000, delay, kQuiet);
    expect_quiet(kTouch, 2000, delay, {1, 3, 0.94, 1.06});
  }
}

TEST(EncoderSteps, OfATouchWithoutFrictionShakeTheTipAtFiveMillimetresASecondAtMost) {
  expect_quiet(kSmoothTouch, 1000, 0, {5, 5, 0.95, 1.05});
}

TEST(EncoderSteps, OfATouchAreQuietWhereItsInertiaIsMistaken) {
  for (const double error : {0.5, 2.0}) {
    expect_quiet(kTouch, 1000, 0, kQuiet, [error](Parameters& p) { p.inertia_error = error; });
  }
}

TEST(EncoderSteps, OfAFalconAreQuietAndItsWallsAreFeltAsTheyAreSet) {
  for (const double wall : {3000.0, 8000.0}) expect_quiet(kFalcon, wall, 0, {0.2, 1.5, 0.98, 1.03});
}

TEST(EncoderSteps, OfFineDevicesAreQuietOnStiffWalls) {
  for (int delay = 0; delay <= 2; ++delay) {
    for (const DeviceToPress& device : {kOmega, kInverse3})
      expect_quiet(device, 10000, delay, kQuiet);
  }
}

TEST(EncoderSteps, AreAsQuietWithAFasterTick) {
  const auto fast = [](Parameters& p) { p.tick = 2.5e-4; };
  expect_quiet(kTouch, 1000, 0, kQuiet, fast);
  expect_quiet(kFalcon, 8000, 0, kQuiet, fast);
  expect_quiet(kOmega, 10000, 0, kQuiet, fast);
}

// On walls that are far stiffer than those that are named for these devices.
TEST(EncoderSteps, GiveNoMoreThanThePromiseOnTheStiffestWalls) {
  for (const DeviceToPress& device : {kTouch, kSmoothTouch, kFalcon, kOmega, kInverse3}) {
    const int latest = device.friction == 0 ? 1 : 2;
    for (int delay = 0; delay <= latest; ++delay) {
      const Worst worst = worst_of(device, 20000, kUndamped, delay);
      EXPECT_LE(worst.given, 5) << device.file << ", " << delay << " ms";
    }
  }
}

}  // namespace
}  // namespace limpid
