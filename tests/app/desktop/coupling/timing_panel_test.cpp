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
  EXPECT_THAT(words.missed, Not(HasSubstr("are caught up")));
  EXPECT_THAT(words.slipped, HasSubstr("with motors they are never made up for"));
  EXPECT_THAT(words.after_a_slip, HasSubstr("were skipped"));
  EXPECT_THAT(words.after_a_slip, Not(HasSubstr("20 ticks")));
}

TEST(TimingPanel, SaysThatTheVirtualArmCatchesUpUntilAStall) {
  const LateTicks words = late_ticks(false);
  EXPECT_THAT(words.missed, HasSubstr("they are caught up"));
  EXPECT_THAT(words.after_a_slip, HasSubstr("over 20 ticks"));
}

}  // namespace
}  // namespace limpid
