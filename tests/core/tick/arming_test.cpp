// Arming: every event in every state, and a long random walk.
#include "core/tick/arming.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/support/random_arm.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::Random;
using enum Arming;
using test::T;

// The table is written out again from the description, in words.
TEST(Arming, GoesWhereEachEventTakesIt) {
  using Event = ArmingEvent;
  const std::map<std::pair<Arming, Event>, Arming> moves{
      {{off, Event::arm}, waiting},     {{waiting, Event::cut}, off},
      {{waiting, Event::hand}, fading}, {{waiting, Event::trip}, tripped},
      {{fading, Event::cut}, off},      {{fading, Event::no_hand}, waiting},
      {{fading, Event::gap}, waiting},  {{fading, Event::full}, on},
      {{fading, Event::trip}, tripped}, {{on, Event::cut}, off},
      {{on, Event::no_hand}, waiting},  {{on, Event::gap}, waiting},
      {{on, Event::held_back}, fading}, {{on, Event::trip}, tripped},
      {{tripped, Event::arm}, waiting}, {{tripped, Event::cut}, off},
  };
  for (int s = 0; s < 5; ++s) {
    for (int e = 0; e < 8; ++e) {
      const auto state = static_cast<Arming>(s);
      const auto event = static_cast<Event>(e);
      const auto found = moves.find({state, event});
      EXPECT_EQ(after(state, event), found == moves.end() ? state : found->second)
          << "state " << s << ", event " << e;
    }
  }
}

TEST(ForceGate, StartsOffWhereMotorsAreReal) {
  ForceGate gate;
  gate.start(false);
  for (int k = 0; k < 5000; ++k) gate.step(ForceRequest::as_it_is, {}, T);
  EXPECT_EQ(gate.state(), off);
  EXPECT_EQ(gate.gain(), 0);
  EXPECT_EQ(gate.why(), ForceState::off);
}

TEST(ForceGate, FadesInOverHalfASecond) {
  ForceGate gate;
  gate.start(false);
  gate.step(ForceRequest::arm, {}, T);
  for (int k = 1; k < 500; ++k) {
    ASSERT_NEAR(gate.gain(), k * T / 0.5, 1e-12);
    ASSERT_EQ(gate.state(), fading);
    ASSERT_FALSE(gate.steady());
    gate.step(ForceRequest::as_it_is, {}, T);
  }
  gate.step(ForceRequest::as_it_is, {}, T);
  EXPECT_EQ(gate.gain(), 1);
  EXPECT_EQ(gate.state(), on);
  EXPECT_TRUE(gate.steady());
}

// A gate that is open to full force.
struct OpenGate : testing::Test {
  OpenGate() {
    gate.start(false);
    arm();
  }
  void arm() {
    gate.step(ForceRequest::arm, {}, T);
    for (int k = 0; k < 600; ++k) gate.step(ForceRequest::as_it_is, {}, T);
    ASSERT_EQ(gate.state(), on);
  }
  ForceGate gate;
};

TEST_F(OpenGate, IsShutAtOnceWhenCutAlsoByOneWhoArmsInTheSameTickLater) {
  gate.step(ForceRequest::cut, {}, T);
  EXPECT_EQ(gate.state(), off);
  EXPECT_EQ(gate.gain(), 0);
}

TEST_F(OpenGate, StaysShutAfterAFaultUntilArmedAnew) {
  for (int i = static_cast<int>(ForceState::stale); i <= static_cast<int>(ForceState::unwatched);
       ++i) {
    const auto reason = static_cast<ForceState>(i);
    gate.step(ForceRequest::as_it_is, {.fault = reason}, T);
    EXPECT_EQ(gate.state(), tripped);
    EXPECT_EQ(gate.gain(), 0);
    for (int k = 0; k < 3000; ++k) gate.step(ForceRequest::as_it_is, {}, T);
    EXPECT_EQ(gate.why(), reason) << "it is said as long as it stays";
    EXPECT_EQ(gate.gain(), 0);
    gate.step(ForceRequest::arm, {.fault = reason}, T);
    EXPECT_EQ(gate.state(), tripped) << "while it lasts nobody can arm";
    gate.step(ForceRequest::arm, {}, T);
    EXPECT_EQ(gate.state(), fading);
    EXPECT_NEAR(gate.gain(), 0.002, 1e-12);
    arm();
  }
}

TEST_F(OpenGate, SaysWhatWasWrongFirstUnlessTheDeviceIsGone) {
  gate.step(ForceRequest::as_it_is, {.fault = ForceState::fault}, T);
  gate.step(ForceRequest::as_it_is, {.fault = ForceState::stale}, T);
  EXPECT_EQ(gate.why(), ForceState::fault);
  gate.step(ForceRequest::as_it_is, {.fault = ForceState::lost}, T);
  gate.step(ForceRequest::as_it_is, {.fault = ForceState::stale}, T);
  EXPECT_EQ(gate.why(), ForceState::lost);
}

TEST_F(OpenGate, SaysOnceThatItWasArmedAnew) {
  gate.step(ForceRequest::arm, {}, T);
  EXPECT_FALSE(gate.armed_anew()) << "it was already";
  gate.step(ForceRequest::as_it_is, {.hand = false}, T);
  gate.step(ForceRequest::as_it_is, {.gap = true}, T);
  gate.step(ForceRequest::as_it_is, {.ceiling = 0}, T);
  gate.step(ForceRequest::as_it_is, {}, T);
  EXPECT_FALSE(gate.armed_anew()) << "it comes back by itself";
  for (const bool trips : {false, true}) {
    gate.step(trips ? ForceRequest::as_it_is : ForceRequest::cut,
              {.fault = trips ? ForceState::lost : ForceState::on}, T);
    EXPECT_FALSE(gate.armed_anew());
    gate.step(ForceRequest::arm, {.hand = false}, T);
    EXPECT_TRUE(gate.armed_anew());
    gate.step(ForceRequest::as_it_is, {}, T);
    EXPECT_FALSE(gate.armed_anew());
  }
}

TEST_F(OpenGate, WaitsForTheHandAndFadesInAgain) {
  gate.step(ForceRequest::as_it_is, {.hand = false}, T);
  EXPECT_EQ(gate.state(), waiting);
  EXPECT_EQ(gate.why(), ForceState::no_hand);
  EXPECT_EQ(gate.gain(), 0);
  EXPECT_TRUE(gate.steady());
  gate.step(ForceRequest::as_it_is, {}, T);
  EXPECT_EQ(gate.state(), fading);
  EXPECT_NEAR(gate.gain(), 0.002, 1e-12);
}

TEST_F(OpenGate, BeginsFromNothingAfterAGap) {
  gate.step(ForceRequest::as_it_is, {.gap = true}, T);
  EXPECT_EQ(gate.state(), fading);
  EXPECT_NEAR(gate.gain(), 0.002, 1e-12);
  EXPECT_EQ(gate.why(), ForceState::stalled);
}

TEST_F(OpenGate, IsHeldBackByACeilingAndComesBackSlowly) {
  gate.step(ForceRequest::as_it_is, {.limited = ForceState::too_fast, .ceiling = 0.3}, T);
  EXPECT_EQ(gate.gain(), 0.3);
  EXPECT_EQ(gate.state(), fading);
  EXPECT_EQ(gate.why(), ForceState::too_fast);
  gate.step(ForceRequest::as_it_is, {}, T);
  EXPECT_NEAR(gate.gain(), 0.302, 1e-12);
  gate.step(ForceRequest::as_it_is, {.limited = ForceState::too_fast, .ceiling = -1}, T);
  EXPECT_EQ(gate.gain(), 0);
  gate.step(ForceRequest::as_it_is, {.ceiling = std::nan("")}, T);
  EXPECT_EQ(gate.gain(), 0) << "no number is no force";
}

TEST_F(OpenGate, TellsOfAFaultWhileItIsOff) {
  gate.step(ForceRequest::cut, {.fault = ForceState::lost}, T);
  EXPECT_EQ(gate.state(), off);
  EXPECT_EQ(gate.why(), ForceState::lost);
  gate.step(ForceRequest::as_it_is, {}, T);
  EXPECT_EQ(gate.why(), ForceState::off);
}

TEST(ForceGate, NeverOpensWithoutBeingArmedWhateverHappens) {
  Random random(40);
  ForceGate gate;
  gate.start(false);
  bool asked = false;  // since the gate was last off or tripped
  double before = 0;
  int opened = 0;
  for (int k = 0; k < 1'000'000; ++k) {
    const double dice = random.between(0, 1);
    const ForceRequest wish = dice < 0.0005   ? ForceRequest::arm
                              : dice > 0.9998 ? ForceRequest::cut
                                              : ForceRequest::as_it_is;
    Objections against;
    against.hand = random.between(0, 1) > 0.0005;
    against.gap = random.between(0, 1) < 0.0003;
    if (random.between(0, 1) < 0.0003) against.fault = ForceState::stale;
    if (random.between(0, 1) < 0.001) against.ceiling = random.between(-0.2, 1.2);
    if (random.between(0, 1) < 0.00005) gate.start(false), asked = false, before = 0;
    if (wish == ForceRequest::arm) asked = true;
    if (wish == ForceRequest::cut) asked = false;
    gate.step(wish, against, T);
    if (against.fault != ForceState::on) asked = false;
    ASSERT_TRUE(asked || gate.gain() == 0) << k;
    ASSERT_LE(gate.gain(), before + T / 0.5 + 1e-12) << k;
    ASSERT_LE(gate.gain(), against.gap || !against.hand ? 0.002 + 1e-12 : 1) << k;
    ASSERT_GE(gate.gain(), 0);
    ASSERT_LE(gate.gain(), 1);
    ASSERT_EQ(gate.state() == on, gate.gain() == 1) << k;
    opened += gate.gain() == 1 && before < 1 ? 1 : 0;
    before = gate.gain();
  }
  EXPECT_GT(opened, 50);
}

}  // namespace
}  // namespace limpid
