#include "app/desktop/coupling/timing_panel.h"

#include <gmock/gmock.h>

namespace limpid {
namespace {

using testing::HasSubstr;
using testing::Not;

// A person who holds a device with motors must not read that its ticks come in a burst after a
// stall.
TEST(TimingPanel, SaysThatWithMotorsLateTicksAreGivenUpAtOnce) {
  const LateTicks words = late_ticks(true);
  EXPECT_THAT(words.missed, Not(HasSubstr("runs faster until it is on time again")));
  EXPECT_THAT(words.slipped, HasSubstr("never runs skipped ticks later"));
  EXPECT_THAT(words.after_a_slip, HasSubstr("skipped ticks"));
  EXPECT_THAT(words.after_a_slip, Not(HasSubstr("20 ticks")));
}

TEST(TimingPanel, SaysThatTheVirtualArmCatchesUpUntilAStall) {
  const LateTicks words = late_ticks(false);
  EXPECT_THAT(words.missed, HasSubstr("runs faster until it is on time again"));
  EXPECT_THAT(words.after_a_slip, HasSubstr("more than 20 ticks"));
}

}  // namespace
}  // namespace limpid
