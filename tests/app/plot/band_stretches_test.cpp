#include <gtest/gtest.h>

#include "app/plot/trace.h"

namespace limpid {
namespace {

// A second of 0, half a second of 3, a second of 0, in milliseconds.
History three_parts() {
  History history({.channels = 1, .seconds = 5});
  for (int i = 0; i < 2500; ++i) history.append(i * 0.001, std::array{i / 500 == 2 ? 3.0 : 0.0});
  return history;
}

std::vector<BandStretch> seen(const Band& band, const History& history) {
  std::vector<SampleIndex> rows;
  pixel_rows(history, {.per_pixel = 0.01, .first_pixel = 0, .pixels = 250}, rows);
  return band_stretches(band, history, rows);
}

TEST(BandStretches, AreWhereTheChannelSaysSo) {
  const auto all = seen({.names = {"", "one", "two", "three"}}, three_parts());
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].said, 0);
  EXPECT_EQ(all[1].said, 3);
  EXPECT_EQ(all[2].said, 0);
  EXPECT_NEAR(static_cast<double>(all[1].from), 100, 1);
  EXPECT_NEAR(static_cast<double>(all[1].to), 150, 1);
  EXPECT_EQ(all[0].to, all[1].from);
}

TEST(BandStretches, OfANumberWithoutANameAreThoseOfTheLastName) {
  const auto all = seen({.names = {"", "one"}}, three_parts());
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[1].said, 1);
}

TEST(BandStretches, AreNoneWhereNothingChangesAndOneStateIsAsUsualAsTheOther) {
  History same({.channels = 1, .seconds = 5});
  for (int i = 0; i < 2500; ++i) same.append(i * 0.001, std::array{1.0});
  EXPECT_TRUE(seen({.names = {"standard", "proposed"}}, same).empty());
  EXPECT_EQ(seen({.names = {"", "force off"}}, same).size(), 1u) << "the unusual is always told";
  EXPECT_TRUE(seen({.names = {""}}, History({.channels = 1})).empty());
}

}  // namespace
}  // namespace limpid
