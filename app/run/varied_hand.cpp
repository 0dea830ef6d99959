#include "app/run/varied_hand.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "core/math/elementary.h"

namespace limpid {
namespace {

constexpr double kSampleRate = 100;      // of a path's samples [Hz]
constexpr double kTremor = 5e-5;         // amplitude of one sine of it [m]
constexpr std::size_t kTremorSines = 3;  // an axis

struct Sine {
  double frequency, phase;  // [Hz], [rad]
};

// Difference of one trial from the path it follows.
struct Manner {
  double horizontal, vertical;  // factors on the distance from the start
  double duration;              // factor
  double hurry;                 // the pace varies between 1 - hurry and 1 + hurry
  std::array<std::array<Sine, kTremorSines>, 3> tremor;
};

Manner manner_of(std::uint64_t seed, std::uint64_t variation) {
  std::seed_seq mixed{seed & 0xffffffff, seed >> 32, variation & 0xffffffff, variation >> 32};
  std::mt19937_64 random(mixed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  Manner m{};
  m.horizontal = between(0.85, 1.15);
  m.vertical = between(0.95, 1.05);
  m.duration = between(0.85, 1.15);
  m.hurry = between(-0.2, 0.2);
  for (auto& axis : m.tremor) {
    for (Sine& s : axis) s = {between(8, 12), between(0, 2 * std::numbers::pi)};
  }
  return m;
}

Vec3 tremor_at(const Manner& m, double t) {
  Vec3 sum = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    for (const Sine& s : m.tremor[static_cast<std::size_t>(axis)]) {
      sum[axis] += kTremor * sine(2 * std::numbers::pi * s.frequency * t + s.phase);
    }
  }
  return sum;
}

}  // namespace

HandPath varied(const HandPath& path, std::uint64_t seed, std::uint64_t variation) {
  const Manner m = manner_of(seed, variation);
  const Vec3 start = path.position.front();
  const Vec3 factor(m.horizontal, m.horizontal, m.vertical);
  const double duration = m.duration * path.duration();
  const int last = static_cast<int>(std::floor(duration * kSampleRate));
  std::string csv = "time_s,x_m,y_m,z_m\n";
  for (int i = 0; i <= last; ++i) {
    const double u = static_cast<double>(i) / last;
    const double pace = u + m.hurry * sine(2 * std::numbers::pi * u) / (2 * std::numbers::pi);
    const double t = i / kSampleRate;
    // The tremor grows from and fades to nothing, so that a trial starts and ends at rest.
    const Vec3 p = start + factor.cwiseProduct(path.at(pace * path.duration()) - start) +
                   sine(std::numbers::pi * u) * tremor_at(m, t);
    csv += fmt::format("{},{},{},{}\n", t, p.x(), p.y(), p.z());
  }
  return parse_hand_csv(csv,
                        fmt::format("{}, variation {} of seed {}", path.source, variation, seed));
}

}  // namespace limpid
