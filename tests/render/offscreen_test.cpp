#include "render/gl/offscreen.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "render/model/gltf_material.h"
#include "tests/support/computer.h"
#include "tests/support/faultless_context.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

TEST(OffscreenContext, IsCurrentAsLongAsItLivesAndLeavesNoneBehind) {
  for (int i = 0; i < 3; ++i) {
    const OffscreenContext context(8, 8);
    EXPECT_NE(eglGetCurrentContext(), EGL_NO_CONTEXT);
  }
  EXPECT_EQ(eglGetCurrentContext(), EGL_NO_CONTEXT);
}

using Bytes = std::vector<unsigned char>;

TEST(OffscreenContext, RefusesAPictureOfNoSize) {
  EXPECT_THROW(OffscreenContext(0, 8), std::runtime_error);
  EXPECT_THROW(OffscreenContext(8, 0), std::runtime_error);
}

// Two pixels wide, three high, all different.
const Bytes kPixels{10, 20, 30, 255, 40, 50, 60, 255, 70, 80,  90,  255,
                    1,  2,  3,  255, 4,  5,  6,  255, 7,  208, 209, 255};

TEST(Png, HasThePixelsItWasMadeOf) {
  for (const unsigned per_metre : {0u, 11811u}) {
    const auto back = ModelImages().decode(png_of(2, 3, kPixels, per_metre), "a.png");
    ASSERT_TRUE(back);
    EXPECT_EQ(back->width, 2);
    EXPECT_EQ(back->height, 3);
    EXPECT_EQ(back->rgba, kPixels);
  }
}

// 300 dots an inch are 11811 a metre. The chunk is that of the PNG specification, 11.3.5.3, with
// the checksum that zlib's crc32 gives for it.
TEST(Png, SaysHowLargeItIsOnPaper) {
  const Bytes plain = png_of(2, 3, kPixels), printed = png_of(2, 3, kPixels, 11811);
  const Bytes chunk{0,    0, 0, 9,    'p',  'H', 'Y',  's',  0,    0,   0x2e,
                    0x23, 0, 0, 0x2e, 0x23, 1,   0x78, 0xa5, 0x3f, 0x76};
  ASSERT_EQ(printed.size(), plain.size() + chunk.size());
  const auto behind_header = printed.begin() + 8 + 25;
  EXPECT_EQ(Bytes(behind_header, behind_header + 21), chunk);
  EXPECT_EQ(Bytes(printed.begin(), behind_header), Bytes(plain.begin(), plain.begin() + 33));
  EXPECT_EQ(Bytes(behind_header + 21, printed.end()), Bytes(plain.begin() + 33, plain.end()));
}

// The checksum is that which zlib's crc32 gives.
TEST(Png, SaysWhatItIs) {
  const Bytes png = png_of(2, 3, kPixels, 0, "limpid 9, seed 1");
  const std::string text(png.begin() + 8 + 25, png.end());
  EXPECT_THAT(text, testing::StartsWith(std::string("\0\0\0\x1ctEXtDescription\0", 20) +
                                        "limpid 9, seed 1\xcd\x50\x94\x35"));
}

TEST(Png, IsOfAsManyPixelsAsItSays) {
  EXPECT_NO_THROW(png_of(3, 2, kPixels));
  for (const auto& [width, height] : {std::pair(2, 2), {3, 3}, {0, 3}, {2, 0}, {-2, -3}, {6, 2}}) {
    EXPECT_THROW(png_of(width, height, kPixels), std::invalid_argument) << width << height;
  }
}

TEST(Png, IsWrittenOrSaysWhyNot) {
  const test::TempDir dir;
  write_png(dir / "a.png", 2, 3, kPixels);
  std::ifstream in(dir / "a.png", std::ios::binary);
  EXPECT_EQ(Bytes(std::istreambuf_iterator<char>(in), {}), png_of(2, 3, kPixels));
  try {
    write_png(dir / "nowhere/a.png", 2, 3, kPixels);
    FAIL() << "there is no such folder";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("nowhere/a.png: the picture cannot be written"));
    EXPECT_THAT(error.what(), testing::HasSubstr("No such file"));
  }
}

class Pixels : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::has_offscreen_pictures()) GTEST_SKIP() << "no EGL here";
    context_ = std::make_unique<test::FaultlessContext>(4, 3);
    fill(0x102030);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 2, 1, 1);  // the left end of the top row
    fill(0xff8040);
    glScissor(3, 0, 1, 1);  // the right end of the lowest
    fill(0x00c0ff);
    glDisable(GL_SCISSOR_TEST);
  }
  static Bytes expected() {
    Bytes all;
    for (int i = 0; i < 12; ++i) all.insert(all.end(), {0x10, 0x20, 0x30, 255});
    std::ranges::copy(Bytes{0xff, 0x80, 0x40}, all.begin());
    std::ranges::copy(Bytes{0x00, 0xc0, 0xff}, all.begin() + 4 * 11);
    return all;
  }
  std::unique_ptr<test::FaultlessContext> context_;
};

TEST_F(Pixels, AreReadFromTheTopRowOn) { EXPECT_EQ(read_rgba(4, 3), expected()); }

TEST_F(Pixels, OfAPictureApartLeaveTheCallersAsTheyWere) {
  GLint before = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &before);
  glViewport(1, 2, 3, 1);
  const Bytes apart = drawn_rgba(5, 2, [] {
    GLint size[4] = {};
    glGetIntegerv(GL_VIEWPORT, size);
    EXPECT_THAT(size, testing::ElementsAre(0, 0, 5, 2));
    fill(0x445566);
  });
  ASSERT_EQ(apart.size(), 40u);
  for (std::size_t i = 0; i < apart.size(); i += 4) {
    EXPECT_THAT(
        Bytes(apart.begin() + static_cast<long>(i), apart.begin() + static_cast<long>(i) + 4),
        testing::ElementsAre(0x44, 0x55, 0x66, 255));
  }
  GLint after = 0, viewport[4] = {};
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &after);
  glGetIntegerv(GL_VIEWPORT, viewport);
  EXPECT_EQ(after, before);
  EXPECT_THAT(viewport, testing::ElementsAre(1, 2, 3, 1));
  EXPECT_EQ(read_rgba(4, 3), expected());
}

TEST_F(Pixels, AreNotOfAPictureThatOpenGlRefuses) {
  EXPECT_THROW(drawn_rgba(1 << 24, 1, [] {}), std::runtime_error);
  while (glGetError() != GL_NO_ERROR) {  // it has said so
  }
}

}  // namespace
}  // namespace limpid
