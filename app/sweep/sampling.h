// Points spread over the unit cube.
#pragma once

#include <cstdint>
#include <vector>

namespace limpid {

// `count` values in [0, 1) for each of `dimensions`: [dimension][sample]. The same seed gives the
// same everywhere.
using UnitSamples = std::vector<std::vector<double>>;

UnitSamples random_samples(std::size_t dimensions, std::size_t count, std::uint64_t seed);
// Latin hypercube: in each dimension one value in every interval of 1 / count.
UnitSamples latin_samples(std::size_t dimensions, std::size_t count, std::uint64_t seed);
// Sobol's sequence from its second point on, shifted by the seed round the cube (Cranley and
// Patterson).
UnitSamples sobol_samples(std::size_t dimensions, std::size_t count, std::uint64_t seed);

}  // namespace limpid
