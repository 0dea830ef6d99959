#include <gtest/gtest.h>

#include "app/desktop/widgets/picture_shelf.h"

namespace limpid {
namespace {

constexpr Rgb kSheet = rgb(0x16191d);

std::array<int, 3> turned(unsigned char r, unsigned char g, unsigned char b) {
  std::array<unsigned char, 4> pixel{r, g, b, 255};
  onto_dark(pixel, kSheet);
  EXPECT_EQ(pixel[3], 255);
  return {pixel[0], pixel[1], pixel[2]};
}

TEST(AFigureInTheDark, HasTheSheetForPaperAndWhiteForInk) {
  EXPECT_EQ(turned(255, 255, 255), (std::array{0x16, 0x19, 0x1d}));
  EXPECT_EQ(turned(0, 0, 0), (std::array{255, 255, 255}));
}

TEST(AFigureInTheDark, KeepsHues) {
  const auto orange = turned(0xe6, 0x9f, 0x00);
  EXPECT_GT(orange[0], orange[1]);
  EXPECT_GT(orange[1], orange[2]);
  const auto blue = turned(0x00, 0x72, 0xb2);
  EXPECT_GT(blue[2], blue[1]);
  EXPECT_GT(blue[1], blue[0]);
}

TEST(AFigureInTheDark, ShowsDarkInkBrighterThanItsGrid) {
  EXPECT_GT(turned(0x22, 0x22, 0x22)[1], turned(0xd8, 0xd8, 0xd8)[1]);
}

}  // namespace
}  // namespace limpid
