// The standard coupling with an energy tank on each side, after the two-layer control of Franken et
// al. (2011).
//
// Energy that a side gives comes out of its tank, energy it takes goes in; energy sent to the other
// side leaves one tank before it enters the other. So both together never give more than they held
// at the start and took in, however the link delays, loses or reorders packets.
//
// The accounts hold what the motors and the proxy's drive really did. Two dampers that nothing
// commands count as intake, as they do in E_c: the device's own, as far as it is sure, and the
// proxy's.
#pragma once

#include <array>
#include <memory>

#include "core/base/field.h"
#include "core/coupling/law_info.h"

namespace limpid {

// Two-layer passivity (Franken, Stramigioli, Misra, Secchi, Macchelli 2011).
struct TankLaw {
  static constexpr std::array kSliders{"coupling.k_vc",      "coupling.b_vc", "coupling.b_v",
                                       "coupling.per_joint", "tank.energy",   "tank.damping",
                                       "link.delay",         "link.jitter",   "link.loss"};
  static constexpr LawInfo kInfo{
      .key = "tank",
      .label = "Tank",
      .meaning =
          "the standard coupling with an energy tank on each side. The tanks limit the energy "
          "given, whatever happens on the link between them.",
      .verdict = "Passive at any delay. Walls are soft. The arm is as heavy as with Standard.",
      .promise = Promise::tanks,
      .for_links = true,
      .through_link = "passive at any delay, jitter and loss",
      .sliders = kSliders,
  };

  struct Settings {
    double tank_energy = 0.005;  // E0, in both tanks at the start [J]
    double tank_most = 0.1;      // most that each tank keeps [J]
    double tank_share = 0.02;    // share of a tank's energy above E0/2 that is sent in a tick [-]
    double tank_damping = 100;   // damper of an empty tank, over the device's inertia [1/s]

    template <class P>
    static constexpr std::array<Field<P>, 4> settings() {
      return {{{"tank.energy", "tanks E\xE2\x82\x80", "Energy of both tanks", &P::tank_energy, "J",
                1e-4, 1, 1e-3, 0.02, true, true,
                "Tank coupling: energy of both tanks at the start, half in each tank. Coupling and "
                "device together never give more than this energy plus the energy that came in."},
               {"tank.most", "tank's limit", "tank's limit", &P::tank_most, "J", 1e-4, 100, 1e-2, 1,
                true, true,
                "Tank coupling: largest energy that each tank keeps. In any time interval the "
                "coupling may give this much more energy than it took."},
               {"tank.share", "tank's share", "tank's share", &P::tank_share, "-", 1e-4, 1, 1e-3, 1,
                true, true,
                "Tank coupling: share of the surplus that a tank sends to the other tank in each "
                "tick. The surplus is the tank's energy above half of tank.energy."},
               {"tank.damping", "refill", "Refilling damper", &P::tank_damping, "1/s", 0, 200, 0,
                200, false, true,
                "Tank coupling: damper that fills the device's tank with energy from the hand "
                "while the tank holds less than half of tank.energy. The damping is at most this "
                "rate times the device's inertia."}}};
    }
  };

  // Makes the law.
  template <int N>
  static std::unique_ptr<Law<N>> make();
  // The stiffest wall under the law, and what is felt in free motion at f [Hz].
  static TipWall wall(const LawSettings& p, const LawAtTip& at);
  static FeltAtTip felt(const LawSettings& p, const LawAtTip& at, double f);
};

}  // namespace limpid
