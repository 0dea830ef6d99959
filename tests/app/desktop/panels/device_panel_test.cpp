#include "app/desktop/panels/device_panel.h"

#include <gtest/gtest.h>

namespace limpid {
namespace {

TEST(DevicePanel, HandsNoLawMoreDelayThanItCanReckonWith) {
  Parameters p;
  EXPECT_EQ(reckoning_with(p, 0.0021).delay, 2);
  EXPECT_EQ(reckoning_with(p, 0.0004).delay, 0);
  p.tick = 1e-4;
  EXPECT_EQ(reckoning_with(p, 0.0015).delay, 15);
  EXPECT_EQ(reckoning_with(p, 0.012).delay, 20) << "120 ticks have no room in its ring";
}

}  // namespace
}  // namespace limpid
