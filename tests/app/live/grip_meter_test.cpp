// The grip, measured in the running loop.
#include "app/live/grip_meter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "devices/identify/grip_probe.h"
#include "tests/support/built_in.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;

class AGripMeter : public testing::Test {
 protected:
  AGripMeter() {
    Parameters p;
    p.hand_stiffness = 520;
    p.hand_damping = 3;
    p.hand_mass_at_tip = 0.1;
    open(p);
  }
  void open(const Parameters& p) {
    session_.open(arm_, Scene{}, p, Vec3(0.19, 0, 0));
    EXPECT_TRUE(pass(30));
  }
  // Turns until so many more ticks have gone by, or `done`.
  bool pass(std::uint64_t ticks, const std::function<bool()>& done = {}) {
    const std::uint64_t last = ticks_ + ticks;
    return test::until([&] {
      session_.turn([this](LaneRows rows, std::uint64_t) {
        meter_.take(rows[kMainLane]);
        const auto force = session_.loop().layout().in(rows[kMainLane], Column::excitation);
        pushed_ = pushed_ || Vec3(force.data()) != Vec3::Zero();
        ++ticks_;
      });
      meter_.update();
      return done ? done() : ticks_ >= last;
    });
  }
  bool pushed_since() {
    pushed_ = false;
    EXPECT_TRUE(pass(50));
    return pushed_;
  }

  ArmDescription arm_ = test::omni();
  LiveSession session_{{}};
  GripMeter meter_{session_};
  std::uint64_t ticks_ = 0;
  bool pushed_ = false;
};

TEST_F(AGripMeter, MeasuresTheVirtualHandOnRequestAndEndsByItself) {
  EXPECT_FALSE(pushed_since());
  meter_.begin(arm_, Scene{});
  EXPECT_TRUE(meter_.busy());
  EXPECT_NE(meter_.why_not(), "");
  EXPECT_TRUE(pushed_since());
  ASSERT_TRUE(pass(0, [&] { return !meter_.busy(); }));
  EXPECT_FALSE(pushed_since());
  // A busy computer may have stopped the loop for a moment: it is measured again then.
  ASSERT_TRUE(test::until([&] {
    if (meter_.found() != nullptr && meter_.found()->grip.known()) return true;
    session_.loop().arm();
    EXPECT_TRUE(pass(0, [&] { return session_.loop().snapshot().arming == Arming::on; }));
    meter_.begin(arm_, Scene{});
    EXPECT_TRUE(pass(0, [&] { return !meter_.busy(); }));
    return false;
  }));
  const Grip& grip = meter_.found()->grip;
  EXPECT_NEAR(grip.stiffness.value, 520, 0.05 * 520);
  EXPECT_NEAR(grip.damping.value, 3, 0.05 * 3);
  EXPECT_NEAR(grip.mass.value, 0.1, 0.05 * 0.1);
  EXPECT_TRUE(meter_.found()->hands);
}

TEST_F(AGripMeter, EndsAtOnceWithTheForceAndDoesNotBeginAgain) {
  meter_.begin(arm_, Scene{});
  EXPECT_TRUE(pushed_since());
  session_.loop().cut();
  ASSERT_TRUE(pass(0, [&] { return !meter_.busy(); }));
  ASSERT_NE(meter_.found(), nullptr);
  EXPECT_THAT(meter_.found()->grip.unknown,
              testing::HasSubstr("the force was switched off: not armed"));
  EXPECT_EQ(meter_.why_not(), "The force is off. Arm the force first.");
  session_.loop().arm();
  ASSERT_TRUE(pass(0, [&] { return session_.loop().snapshot().arming == Arming::on; }));
  EXPECT_FALSE(pushed_since());
}

TEST_F(AGripMeter, DoesNotBeginWithoutForce) {
  session_.loop().cut();
  ASSERT_TRUE(pass(0, [&] { return session_.loop().snapshot().arming != Arming::on; }));
  meter_.begin(arm_, Scene{});
  EXPECT_FALSE(meter_.busy());
  EXPECT_FALSE(pushed_since());
}

TEST_F(AGripMeter, EndsWhereItIsStoppedOrTheLoopStartsOver) {
  meter_.begin(arm_, Scene{});
  EXPECT_TRUE(pushed_since());
  meter_.stop();
  EXPECT_TRUE(pass(50));
  EXPECT_FALSE(pushed_since());
  EXPECT_EQ(meter_.found(), nullptr);
  meter_.begin(arm_, Scene{});
  EXPECT_TRUE(pushed_since());
  ++session_.controls().resets;
  EXPECT_TRUE(pass(50));
  EXPECT_FALSE(pushed_since());
}

TEST_F(AGripMeter, IsOverInAnotherWorld) {
  meter_.begin(arm_, Scene{});
  EXPECT_TRUE(pushed_since());
  meter_.forget();
  open({});
  EXPECT_FALSE(pushed_since());
  EXPECT_FALSE(meter_.busy());
}

}  // namespace
}  // namespace limpid
