#include <gmock/gmock.h>

#include "app/experiments/experiment.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using testing::HasSubstr;

TEST(Conditions, AreNotSaidOfNothing) { EXPECT_EQ(Conditions().text(), ""); }

TEST(Conditions, OfOneRunNameAllThatItWasMadeUnder) {
  Conditions conditions;
  Parameters p;
  p.hand_stiffness = 300;
  p.hand_damping = 2;
  conditions.add(test::omni(), p);
  EXPECT_EQ(conditions.text(),
            "Conditions: arm omni of 3 joints; limit of every motor: the arm's own, 0.45 and 0.64 "
            "N m; grip 300 N/m, 2 N s/m; no mass in the hand; exact encoders; no delay; tick 1 "
            "ms.");
}

TEST(Conditions, OfManyRunsNameEachValueOrTheirEnds) {
  Conditions conditions;
  Parameters p;
  p.torque_limit = 100;
  p.hand_damping = 0;
  for (const double grip : {100., 200., 300., 400., 500.}) {
    p.hand_stiffness = grip;
    conditions.add(test::omni(), p);
  }
  p.hand_mass_at_tip = 0.2;
  p.encoder_step = 1e-4;
  p.device_delay = 2;
  p.tick = 0.002;
  conditions.add(test::random_arm(7, 1), p);
  const std::string text = conditions.text();
  EXPECT_THAT(text, HasSubstr("arm omni, random of 3 to 7 joints"));
  EXPECT_THAT(text, HasSubstr("limit of every motor: 100 N m"));
  EXPECT_THAT(text, HasSubstr("grip 100 to 500 N/m, undamped"));
  EXPECT_THAT(text, HasSubstr("no mass in the hand and 0.2 kg in the hand"));
  EXPECT_THAT(text, HasSubstr("exact encoders and 0.0001 rad per encoder step"));
  EXPECT_THAT(text, HasSubstr("no delay and 4 ms of delay"));
  EXPECT_THAT(text, HasSubstr("tick 1 and 2 ms"));
}

// With strong motors in some runs and the arm's own in others, both are named.
TEST(Conditions, OfMotorsLeaveNoneOut) {
  Conditions conditions;
  Parameters p;
  conditions.add(test::omni(), p);
  p.torque_limit = 100;
  conditions.add(test::omni(), p);
  EXPECT_THAT(conditions.text(), HasSubstr("the arm's own, 0.45 and 0.64 N m; and 100 N m"));
}

}  // namespace
}  // namespace limpid
