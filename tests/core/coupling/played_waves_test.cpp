// Waves played out after a time: sums arrive late, in any order, or not at all.
#include "core/coupling/played_waves.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/dynamics/random.h"

namespace limpid {
namespace {

constexpr double kPlayTick = 0.001;

// Sums of a wave as it is sent, tick by tick.
std::vector<WaveSums<3>> sums_of(const std::vector<Vec<3>>& waves) {
  std::vector<WaveSums<3>> all;
  WaveSums<3> sums{-1, Vec<3>::Zero(), 0};
  for (const Vec<3>& u : waves) {
    sums.add(u, kPlayTick);
    sums.number += 1;
    all.push_back(sums);
  }
  return all;
}

std::vector<Vec<3>> any_waves(std::size_t count) {
  Random random(7);
  std::vector<Vec<3>> waves;
  for (std::size_t i = 0; i < count; ++i) waves.emplace_back(random.vector(3, 1));
  return waves;
}

TEST(PlayedWaves, AreThoseThatWereSentWhereEachPacketComes) {
  const std::vector<Vec<3>> waves = any_waves(60);
  const std::vector<WaveSums<3>> sums = sums_of(waves);
  PlayedWaves<3> played;
  played.start(3);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const Vec<3> u = played.play(sums[k], static_cast<double>(k) - 4, kPlayTick);
    const Vec<3> wanted = k < 4 ? Vec<3>(Vec<3>::Zero()) : waves[k - 4];
    EXPECT_LT((u - wanted).norm(), 1e-9) << k;
  }
}

// A gap is filled evenly, so that the sum is the same and the energy is less.
TEST(PlayedWaves, GoEvenlyWherePacketsAreLost) {
  std::vector<Vec<3>> waves = any_waves(60);
  waves[30] = {1, 0, 0};
  waves[31] = {3, 0, 0};
  const std::vector<WaveSums<3>> sums = sums_of(waves);
  PlayedWaves<3> played;
  played.start(3);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const std::size_t newest = k == 30 ? 29 : k;
    const Vec<3> u = played.play(sums[newest], static_cast<double>(k) - 4, kPlayTick);
    if (k != 34 && k != 35) continue;
    EXPECT_LT((u - Vec<3>(2, 0, 0)).norm(), 1e-9) << k;
  }
}

// Whatever comes, and whenever it is due.
TEST(PlayedWaves, NeverHaveMoreEnergyThanCame) {
  Random random(3);
  const std::vector<WaveSums<3>> sums = sums_of(any_waves(2000));
  PlayedWaves<3> played;
  played.start(3);
  double energy = 0;
  std::size_t newest = 0;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (random.between(0, 1) < 0.3) newest = k;
    const double late = random.between(0, 1) < 0.01 ? 0 : 20;
    const Vec<3> u = played.play(sums[newest], static_cast<double>(k) - late, kPlayTick);
    energy += kPlayTick / 2 * u.squaredNorm();
    ASSERT_LE(energy, sums[newest].energy * (1 + 1e-12)) << k;
  }
  EXPECT_GT(energy, 0.01 * sums.back().energy);
}

}  // namespace
}  // namespace limpid
