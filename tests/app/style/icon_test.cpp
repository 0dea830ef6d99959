#include "app/style/icon.h"

#include <gtest/gtest.h>

#include "app/style/palette.h"

namespace limpid {
namespace {

TEST(Icon, ShowsDeviceAndProxyOnNothingAtEverySize) {
  for (const int size : {16, 32, 64}) {
    const std::vector<std::uint8_t> pixels = icon(size);
    ASSERT_EQ(pixels.size(), static_cast<std::size_t>(4 * size * size));
    const auto opacity = [&](int x, int y) {
      return pixels[static_cast<std::size_t>(4 * (y * size + x) + 3)];
    };
    for (const int x : {0, size - 1}) EXPECT_EQ(opacity(x, 0), 0) << "the corners are clear";
    const auto pixels_of = [&](Ink which) {
      const Rgb rgb = ink(kDarkPalette, which);
      int count = 0;
      for (std::size_t i = 0; i < pixels.size(); i += 4) {
        count += pixels[i] == rgb.r && pixels[i + 1] == rgb.g && pixels[i + 2] == rgb.b &&
                 pixels[i + 3] == 255;
      }
      return count;
    };
    EXPECT_GT(pixels_of(Ink::device), size * size / 100);
    EXPECT_GT(pixels_of(Ink::proxy), size * size / 60);
  }
}

}  // namespace
}  // namespace limpid
