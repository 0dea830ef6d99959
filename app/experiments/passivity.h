// The trials of Fig. 6, which Fig. 7 reads again: free motion, contact, circles on the surface.
#pragma once

#include <span>

#include "app/experiments/experiment.h"

namespace limpid {

// A coupling to compare over all its trials.
struct PassivityCase {
  std::string name;       // "eta = 0.6", "standard"
  std::string file_name;  // "eta-0.6"
  CouplingKind kind = CouplingKind::proposed;
  double eta = 1;
};

inline constexpr std::size_t kTrialsOfACase = 10;

// eta = 0.6, 1, 3, 5 and standard, in this order.
std::span<const PassivityCase> passivity_cases();
// kTrialsOfACase trials with the same hand paths for every case. The first path is an asset.
std::vector<Trial> passivity_trials(const ExperimentArm& on, const PassivityCase& one,
                                    std::uint64_t seed);

}  // namespace limpid
