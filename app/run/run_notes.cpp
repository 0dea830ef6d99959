#include "app/run/run_notes.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "app/run/analysis.h"

namespace limpid {

std::string weak_spring_text(const ArmDescription& arm, const Parameters& p) {
  if (!info(p.kind).has("coupling.k_vc")) return {};
  // Rate at which the spring brings device and proxy together [1/s]; slower than a hand moves.
  constexpr double kSlow = 2 * std::numbers::pi;
  const Eigen::MatrixXd M = arm_at(arm, rest_pose(arm)).M;
  const Eigen::VectorXd springs = coupling_springs(arm, p);
  int weakest = 0;
  const double slowest = (springs.array() / M.diagonal().array()).minCoeff(&weakest);
  const double rate = std::sqrt(slowest);
  if (rate >= kSlow) return {};
  return fmt::format(
      "coupling.k_vc is weak for joint {}: it brings device and proxy together at {:.2g} Hz there, "
      "so that they may drift apart in contact. Gains that are fitted follow the joint with the "
      "least damping",
      arm.joints[static_cast<std::size_t>(weakest)].name, rate / (2 * std::numbers::pi));
}

std::vector<std::string> notes_on(const ArmDescription& arm, const Parameters& p) {
  std::vector<std::string> notes;
  const LawInfo& law = info(p.kind);
  if (p.linked() && !law.knows_link()) {
    notes.push_back(fmt::format("link.* does nothing here: {}", law.through_link));
  }
  if (law.promise == Promise::ledger && p.tick > kTriedTick) {
    notes.push_back(fmt::format(
        "loop.tick {:.4g} ms: the energy account of the law {} was tested only at ticks of up to 1 "
        "ms; at longer ticks the hand may be given more energy than ledger.energy",
        1e3 * p.tick, law.key));
  }
  if (std::string weak = weak_spring_text(arm, p); !weak.empty()) notes.push_back(std::move(weak));
  return notes;
}

}  // namespace limpid
