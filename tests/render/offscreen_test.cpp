#include "render/gl/offscreen.h"

#include <epoxy/egl.h>
#include <gtest/gtest.h>

namespace limpid {
namespace {

TEST(OffscreenContext, IsCurrentAsLongAsItLivesAndLeavesNoneBehind) {
  for (int i = 0; i < 3; ++i) {
    const OffscreenContext context(8, 8);
    EXPECT_NE(eglGetCurrentContext(), EGL_NO_CONTEXT);
  }
  EXPECT_EQ(eglGetCurrentContext(), EGL_NO_CONTEXT);
}

}  // namespace
}  // namespace limpid
