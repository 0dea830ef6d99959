#include "app/experiments/passivity_trials.h"

#include <fmt/format.h>

#include <array>

#include "app/experiments/series.h"
#include "app/run/varied_hand.h"

namespace limpid {
namespace {

const std::array<PassivityCase, 5> kCases{{
    {"eta = 0.6", "eta-0.6", CouplingKind::proposed, 0.6},
    {"eta = 1", "eta-1", CouplingKind::proposed, 1},
    {"eta = 3", "eta-3", CouplingKind::proposed, 3},
    {"eta = 5", "eta-5", CouplingKind::proposed, 5},
    {"standard", "standard", CouplingKind::standard, 1},
}};

}  // namespace

std::span<const PassivityCase> passivity_cases() { return kCases; }

std::vector<Trial> passivity_trials(const PassivityCase& one, std::uint64_t seed) {
  Parameters p;
  p.kind = one.kind;
  p.eta = one.eta;
  std::vector<Trial> trials;
  for (std::size_t i = 0; i < kTrialsOfACase; ++i) {
    Trial trial{fmt::format("{}-{}", one.file_name, i), plan_of("table", "circle", p)};
    trial.folder = "passivity";
    trial.plan.seed = seed;
    if (i > 0) {
      trial.plan.hand = varied(trial.plan.hand, seed, i);
      trial.plan.rows = rows_of(trial.plan);
    }
    trials.push_back(std::move(trial));
  }
  return trials;
}

}  // namespace limpid
