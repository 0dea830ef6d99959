#include "app/desktop/shell/layout.h"

#include <gtest/gtest.h>

namespace limpid {
namespace {

WindowSize window(float width, float height, float scale) {
  return {width, height, scale, 28 * scale, 48 * scale};
}

TEST(WindowLayout, AllPanelsFitAtTheUsualSize) {
  Settings settings;
  const Layout at = WindowLayout()(settings, window(1280, 720, 1));
  EXPECT_TRUE(at.show_left && at.show_right && at.show_plots);
  EXPECT_EQ(at.view.min.x, 300);
  EXPECT_EQ(at.view.max.x, 1280 - 290);
}

TEST(WindowLayout, PartsNeverOverlapAndTheViewKeepsAThirdOfTheWidth) {
  for (const float width : {900.f, 1280.f, 1920.f, 3840.f}) {
    for (const float height : {560.f, 720.f, 1080.f, 2160.f}) {
      for (const float scale : {1.f, 1.5f, 2.f, 3.f}) {
        Settings settings;
        const Layout at = WindowLayout()(settings, window(width, height, scale));
        SCOPED_TRACE(testing::Message() << width << " x " << height << " at " << scale);
        EXPECT_GE(at.view.size().x, width / 3);
        EXPECT_GE(at.view.size().y, height / 4);
        EXPECT_EQ(at.view.min.y, 28 * scale);
        EXPECT_EQ(at.view.min.x, at.show_left ? at.left.max.x : 0);
        EXPECT_EQ(at.view.max.x, at.show_right ? at.right.min.x : width);
        EXPECT_EQ(at.view.max.y, at.show_plots ? at.plots.min.y : at.transport.min.y);
        EXPECT_EQ(at.transport.min.y, at.show_plots ? at.plots.max.y : at.view.max.y);
        EXPECT_EQ(at.transport.max.y, height);
        EXPECT_TRUE(at.show_left || at.show_right);
      }
    }
  }
}

TEST(WindowLayout, OnANarrowWindowTheSidePanelAskedForLastIsTheOneShown) {
  WindowLayout layout;
  Settings settings;
  const WindowSize narrow = window(900, 560, 1.5f);
  Layout at = layout(settings, narrow);
  EXPECT_TRUE(at.show_left);
  EXPECT_FALSE(at.show_right);
  settings.show_right = !settings.show_right;  // as F3 does
  at = layout(settings, narrow);
  EXPECT_FALSE(at.show_left);
  EXPECT_TRUE(at.show_right);
  settings.show_left = !settings.show_left;  // as F2 does
  at = layout(settings, narrow);
  EXPECT_TRUE(at.show_left);
  EXPECT_FALSE(at.show_right);
  settings.show_left = !settings.show_left;
  at = layout(settings, narrow);
  EXPECT_FALSE(at.show_left) << "switched off while it is shown";
  EXPECT_TRUE(at.show_right) << "and there is room for the other one";
}

TEST(WindowLayout, BothPanelsComeBackWithTheRoomForThem) {
  WindowLayout layout;
  Settings settings;
  layout(settings, window(900, 560, 1.5f));
  const Layout at = layout(settings, window(1800, 900, 1.5f));
  EXPECT_TRUE(at.show_left && at.show_right);
}

}  // namespace
}  // namespace limpid
