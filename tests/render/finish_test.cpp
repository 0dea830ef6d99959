#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "render/gl/frame_target.h"
#include "render/gl/offscreen.h"
#include "tests/support/faultless_context.h"

namespace limpid {
namespace {

constexpr int kSize = 64;

void fill_grey(int x, int y, int width, int height, float grey) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(x, y, width, height);
  glClearColor(grey, grey, grey, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
}

// Pixels of a picture of one sample a pixel, filled by `draw`, after the finish.
template <class Draw>
std::vector<unsigned char> finished(Draw&& draw) {
  const test::FaultlessContext context(kSize, kSize);
  GLint framebuffer = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
  FrameTarget target(LIMPID_SOURCE_DIR "/shaders");
  target.begin(kSize, kSize, 1);
  draw();
  const FrameTarget::Area all{0, 0, kSize, kSize};
  target.finish(static_cast<GLuint>(framebuffer), all, all);
  return read_rgba(kSize, kSize);
}

// Green of a pixel; rows count from the top, unlike those of the read picture.
int green(const std::vector<unsigned char>& picture, int x, int y) {
  return picture[static_cast<std::size_t>(4 * ((kSize - 1 - y) * kSize + x) + 1)];
}

TEST(Finish, LeavesLinesAsThinAsAPixelWithoutGaps) {
  for (const int run : {1, 2, 3, 5}) {  // pixels on one level
    const auto level = [&](int x) { return 8 + x / run; };
    const int end = std::min(kSize, 48 * run);
    const auto picture = finished([&] {
      fill_grey(0, 0, kSize, kSize, 0.4f);
      for (int x = 0; x < end; ++x) fill_grey(x, level(x), 1, 1, 0.9f);
    });
    for (int x = 4; x < end - 4; ++x)
      EXPECT_GT(green(picture, x, level(x)), 255 * 0.62) << run << ", " << x;
  }
}

TEST(Finish, SmoothsTheStepsOfAnEdge) {
  const auto picture = finished([] {
    fill_grey(0, 0, kSize, kSize, 0.1f);
    for (int x = 0; x < kSize; ++x) fill_grey(x, 0, 1, 20 + x / 2, 0.9f);
  });
  int between = 0;
  for (int x = 4; x < kSize - 4; ++x)
    for (int y = 4; y < kSize - 4; ++y) {
      const int at = green(picture, x, y);
      between += at > 60 && at < 200 ? 1 : 0;
    }
  EXPECT_GT(between, kSize - 16) << "a pixel a column, about";
}

// A part of the next frame is cleared and drawn; the rest is the last frame's.
TEST(Finish, KeepsThePictureOutsideOfWhatChanges) {
  const test::FaultlessContext context(kSize, kSize);
  GLint framebuffer = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
  FrameTarget target(LIMPID_SOURCE_DIR "/shaders");
  const FrameTarget::Area all{0, 0, kSize, kSize}, part{16, 24, 20, 12};
  const auto frame = [&](const FrameTarget::Area& changed, float grey) {
    const bool is_new = target.begin(kSize, kSize, 1);
    target.clear(changed);
    glClearColor(grey, grey, grey, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    target.finish(static_cast<GLuint>(framebuffer), all, changed);
    return is_new;
  };
  EXPECT_TRUE(frame(all, 0.2f));
  EXPECT_FALSE(frame(part, 0.9f));
  const auto picture = read_rgba(kSize, kSize);
  for (int x = 2; x < kSize; x += 4) {
    for (int y = 2; y < kSize; y += 4) {
      const int right = part.x + part.width, top = part.y + part.height;
      const bool inside = x > part.x + 1 && x < right - 1 && y > part.y + 1 && y < top - 1;
      const bool outside = x < part.x - 2 || x > right + 2 || y < part.y - 2 || y > top + 2;
      if (inside) {
        EXPECT_NEAR(green(picture, x, y), 0.9 * 255, 3) << x << ", " << y;
      }
      if (outside) {
        EXPECT_NEAR(green(picture, x, y), 0.2 * 255, 3) << x << ", " << y;
      }
    }
  }
}

// GL_SAMPLES of the framebuffer that is drawn to.
TEST(AFrameTarget, HasAsManySamplesAsItIsAskedForOrAllThereAre) {
  const test::FaultlessContext context(kSize, kSize);
  GLint most = 0;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  ASSERT_GE(most, 4) << "OpenGL 3 has that many";
  FrameTarget target(LIMPID_SOURCE_DIR "/shaders");
  for (const auto& [asked, given] : {std::pair(4, 4), {1, 0}, {1000, most}, {0, 0}}) {
    EXPECT_TRUE(target.begin(kSize, kSize, asked)) << asked << ": it is a new one";
    GLint samples = -1, viewport[4] = {};
    glGetIntegerv(GL_SAMPLES, &samples);
    EXPECT_EQ(samples, given);
    glGetIntegerv(GL_VIEWPORT, viewport);
    EXPECT_EQ(viewport[2], kSize);
    EXPECT_EQ(viewport[3], kSize);
    if (asked > 0) {
      EXPECT_FALSE(target.begin(kSize, kSize, asked)) << "the same again";
    }
  }
  EXPECT_TRUE(target.begin(kSize + 1, kSize, 1));
  EXPECT_TRUE(target.begin(kSize + 1, kSize + 1, 1));
}

}  // namespace
}  // namespace limpid
