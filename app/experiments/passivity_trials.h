// The trials of Fig. 6, which Fig. 7 reads again: free motion, contact, circles on the surface.
#pragma once

#include <span>

#include "app/experiments/experiment.h"

namespace limpid {

// A hand's path as the same person would follow it another time: a little larger or smaller, faster
// or slower, hurrying here and dawdling there, with a tremor of 8 to 12 Hz. The same seeds give the
// same path.
HandPath varied(const HandPath& path, std::uint64_t seed, std::uint64_t variation);

// One of the couplings compared, over all its trials.
struct PassivityCase {
  std::string name;       // "eta = 0.6", "standard"
  std::string file_name;  // "eta-0.6"
  CouplingKind kind = CouplingKind::proposed;
  double eta = 1;
};

inline constexpr std::size_t kTrialsOfACase = 10;

// eta = 0.6, 1, 3, 5 and standard, in this order.
std::span<const PassivityCase> passivity_cases();
// kTrialsOfACase trials: the same hand paths for every case. The first path is that of the assets.
std::vector<Trial> passivity_trials(const PassivityCase& one, std::uint64_t seed);

}  // namespace limpid
