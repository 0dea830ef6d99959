#include "app/sweep/sampling.h"

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/sobol.hpp>
#include <boost/random/uniform_01.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <cmath>
#include <numeric>

namespace limpid {
namespace {

// Boost's distributions, unlike the standard's, are the same everywhere.
using Random = boost::random::mt19937_64;

double unit(Random& random) { return boost::random::uniform_01<double>()(random); }

}  // namespace

UnitSamples random_samples(std::size_t dimensions, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  UnitSamples samples(dimensions, std::vector<double>(count));
  for (auto& dimension : samples) {
    for (double& x : dimension) x = unit(random);
  }
  return samples;
}

UnitSamples latin_samples(std::size_t dimensions, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  UnitSamples samples(dimensions, std::vector<double>(count));
  std::vector<std::size_t> cell(count);
  for (auto& dimension : samples) {
    std::iota(cell.begin(), cell.end(), std::size_t{0});
    for (std::size_t i = count; i > 1; --i) {  // Fisher and Yates
      std::swap(cell[i - 1],
                cell[boost::random::uniform_int_distribution<std::size_t>(0, i - 1)(random)]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      dimension[i] = (static_cast<double>(cell[i]) + unit(random)) / static_cast<double>(count);
    }
  }
  return samples;
}

UnitSamples sobol_samples(std::size_t dimensions, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> shift(dimensions);
  for (double& s : shift) s = unit(random);
  boost::random::sobol sequence(dimensions);
  UnitSamples samples(dimensions, std::vector<double>(count));
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t d = 0; d < dimensions; ++d) {
      const double x = static_cast<double>(sequence() >> 11) * 0x1p-53 + shift[d];
      samples[d][i] = x - std::floor(x);
    }
  }
  return samples;
}

}  // namespace limpid
