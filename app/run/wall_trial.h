// Trial of the wall that tip_limits() names: in simulation it is tapped, and pressed slowly.
#pragma once

#include <atomic>
#include <string>

#include "core/dynamics/arm_description.h"
#include "core/math/sizes.h"
#include "core/tick/parameters.h"

namespace limpid {

// Bounds for a wall that is held.
struct HeldWall {
  static constexpr double kFelt = 0.05;     // felt stiffness off the set one, over that [-]
  static constexpr double kChatter = 0.02;  // rms speed across the wall above WallTap::kFast [m/s]
};

struct WallTrial {
  double named = 0;   // [N/m]
  double held = 0;    // stiffest wall of named, named/2, named/4, ... that was held; 0: none [N/m]
  std::string fault;  // of the softest wall that was not held; empty: the named one was held
};

// True of laws whose spring lies between hand and wall, so that every wall is felt softer.
bool softens(const LawInfo& law);

// Presses walls of the settings' law, placed at configuration x [rad] across the directions in
// which dampers hold the tip least, and along the axes of its inertia, in hands of 300 and 3000 N/m
// and in the one that is set. A wall is held if a hand that rests on it feels its stiffness within
// HeldWall::kFelt and one encoder step (unless the law softens it), the tip does not tremble, and a
// law with a ledger gives the hand at most its energy. A wall that no hand reaches is not held.
// named: above 0; no scene has walls above 1e6 N/m, so none is tried. `stop` ends the trial early;
// the result is then of no use.
WallTrial try_wall(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p,
                   double named, const std::atomic<bool>* stop = nullptr);

}  // namespace limpid
