#include "app/plot/plot_row.h"

#include <gtest/gtest.h>

namespace limpid {
namespace {

constexpr auto kTime = PlotKind::time, kCross = PlotKind::cross, kSpectrum = PlotKind::spectrum;

TEST(PlotRow, FillsItsRoomWithoutOverlaps) {
  for (const float scale : {1.0f, 1.5f, 2.0f}) {
    for (const ImVec2 room : {ImVec2{880, 130}, {1264, 180}, {1900, 280}, {600, 300}}) {
      for (const auto& kinds : {std::vector{kTime, kTime, kTime, kCross},
                                {kCross},
                                {kSpectrum},
                                {kTime, kCross, kCross, kSpectrum, kTime, kTime, kTime}}) {
        const PlotPlaces at = place_plots(kinds, room, 8, scale);
        ASSERT_EQ(at.places.size(), kinds.size());
        float right = 0;
        for (std::size_t i = 0; i < kinds.size(); ++i) {
          const ScreenRect& place = at.places[i];
          EXPECT_GE(place.width(), 150 * scale) << "of plot " << i;
          EXPECT_GE(place.height(), 120 * std::min(1.0f, room.y / (120 * scale)));
          EXPECT_LE(place.max.x, at.width + 1);
          EXPECT_LE(place.max.y, room.y);
          right = std::max(right, place.max.x);
          if (i == 0 || at.places[i - 1].min.y != place.min.y) continue;
          EXPECT_GE(place.min.x, at.places[i - 1].max.x + 7);
        }
        EXPECT_NEAR(right, at.width, 1);
      }
    }
  }
}

TEST(PlotRow, ShowsTheFourDefaultsAtOnceIn1280) {
  const PlotPlaces at = place_plots({kTime, kTime, kTime, kCross}, {1264, 180}, 8, 1);
  EXPECT_EQ(at.width, 1264);
  EXPECT_EQ(at.places[3].min.y, at.places[0].min.y) << "in one row";
  EXPECT_GT(at.places[0].width(), at.places[3].width());
}

TEST(PlotRow, ScrollsWhatHasNoRoom) {
  EXPECT_GT(place_plots(std::vector(9, kTime), {900, 150}, 8, 1).width, 1700);
}

}  // namespace
}  // namespace limpid
