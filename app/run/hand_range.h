// Stability of each law in all hands of a range, beside that in every hand: walls on an arm's tip,
// without simulating.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "app/run/analysis.h"
#include "app/run/tip_limits.h"
#include "core/coupling/two_port.h"

namespace limpid {

// Stiffnesses of hands that hold the tip; their damping and mass are those of the grip that is set.
struct HandRange {
  double from = 0, to = 0;  // [N/m]
};

// Walls that are stable, or passive.
struct SafeWalls {
  std::optional<double> up_to;  // [N/m]; infinite: every wall; none: no limit is known
  std::optional<double> hand;   // stiffness of the hand that sets the bound [N/m]
  std::string why;
};

struct LawInHands {
  SafeWalls in_range;                 // stable in every hand of the range
  SafeWalls in_any_hand;              // passive, and so stable in every passive hand
  std::optional<Llewellyn> two_port;  // of the least damped joint
  std::string two_port_why;           // why no criterion is known, else what follows
};

// A bound of a wall on the device itself, passive in every hand.
struct NamedBound {
  std::string name, source, rule;
  std::optional<double> wall;  // [N/m]; infinite: no bound; none: it is not known
};

struct InHands {
  HandRange range;
  double damping = 0, mass = 0;  // of the hands [N s/m, kg]
  NamedBound sampled, stepped;   // of Colgate and Schenkel; of Abbott and Okamura
  double eta_min = 0;            // smallest stable one of the proposed law in hands of the range
  double eta_min_any = 0;        // (25)
  std::array<LawInHands, kLaws> laws;
};

// Judges the laws at configuration x [rad]. a, tip: analysis and limits there.
InHands in_hands(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p,
                 const Analysis& a, const TipLimits& tip, const HandRange& range);

}  // namespace limpid
