// Requests for force from other threads, taken once by the loop.
#include "core/tick/force_asked.h"

#include <gtest/gtest.h>

namespace limpid {
namespace {

TEST(ForceAsked, IsTakenOnce) {
  ForceAsked force;
  EXPECT_EQ(force.take(), ForceRequest::as_it_is) << "nobody asked";
  force.arm();
  force.arm();
  EXPECT_TRUE(force.waits());
  EXPECT_EQ(force.take(), ForceRequest::arm);
  EXPECT_FALSE(force.waits());
  EXPECT_EQ(force.take(), ForceRequest::as_it_is) << "both are taken";
}

TEST(ForceAsked, CutWinsAndTakesTheArmingWithIt) {
  ForceAsked force;
  force.cut();
  EXPECT_TRUE(force.waits());
  force.arm();
  EXPECT_EQ(force.take(), ForceRequest::cut);
  EXPECT_EQ(force.take(), ForceRequest::as_it_is) << "an arming from before a cut does not return";
}

}  // namespace
}  // namespace limpid
