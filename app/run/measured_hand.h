// The hand that was measured, and what follows for the laws in it: eta_min and stable walls.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/run/hand_range.h"
#include "app/run/simulate.h"
#include "devices/identify/grip.h"

namespace limpid {

struct MeasuredHand {
  Grip grip;
  // Smallest stable eta of the proposed law in this hand: of the values, and the least and the most
  // within their bounds.
  struct EtaMin {
    double value, low, high;
  };
  std::optional<EtaMin> eta_min;
  // Walls in hands within the bound of the stiffness, with the least damping within its bound.
  std::optional<InHands> hands;
};

// Settings with the grip's values as the hand's, within what these may be.
Parameters with_grip(Parameters p, const Grip& grip);

// Judges the laws in a grip; one that is not known is only handed on. `p`: settings as the loop
// takes them.
MeasuredHand judged(const ArmDescription& arm, const Parameters& p, const Scene& scene, Grip grip);

// Finds the grip that was measured last in a session. Errors: FileError.
Grip recorded_grip(const Session& session, const std::string& where);

// Lets a run measure the grip, from half a second on. False if it is too short for that.
bool measure_grip(RunPlan& plan);
// Time that a run needs for it [s].
double grip_run_duration();

// Returns "310 ± 12 N/m".
std::string bounded_text(const Bounded& of, const char* unit);
// A line about a hand, for people.
struct GripLine {
  std::string label, value;
};
std::vector<GripLine> grip_lines(const MeasuredHand& hand);
// Says that the grip is not known, and why; empty if it is known.
std::string unknown_text(const Grip& grip);

}  // namespace limpid
