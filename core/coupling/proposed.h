// The paper's coupling: spring and damper with feedforward of the observed human force and of the
// contact force, (14)-(15).
//
// The feedforward keeps device and proxy together and scales the impedance felt in slow motion.
#pragma once

#include <array>
#include <memory>

#include "core/coupling/law_info.h"
#include "core/coupling/spring_damper.h"

namespace limpid {

struct ProposedLaw {
  static constexpr std::array kSliders{"coupling.eta",  "observer.alpha", "coupling.k_vc",
                                       "coupling.b_vc", "coupling.b_v",   "coupling.per_joint",
                                       "link.delay",    "link.jitter",    "link.loss"};
  static constexpr LawInfo kInfo{
      .key = "proposed",
      .label = "Proposed",
      .meaning =
          "with feedforward of the observed human force and the contact force, equations "
          "(14)-(15).",
      .verdict = "The law of the paper: without drift, but passive only above \xCE\xB7_min.",
      .promise = Promise::eta_min,
      .loop = LinearLoop::fed_forward,
      .takes_eta = true,
      .observes = true,
      .through_link = "passivity is not known with feedforward",
      .sliders = kSliders,
  };

  struct Settings {
    double eta = 1;  // [-]

    template <class P>
    static constexpr std::array<Field<P>, 1> settings() {
      return {{{"coupling.eta", "\xCE\xB7", "Impedance scaling \xCE\xB7", &P::eta, "-", 0.01, 100,
                0.1, 10, true, true,
                "Impedance scaling: how much of the arm the hand feels in free motion. Predictive "
                "coupling: eta times the inertia M1 + M2, up to coupling.band. Proposed coupling: "
                "eta times the damping, which dominates slow motion. By equation (12) of the paper "
                "the hand feels eta times the inertia; measurements show 0.7 times the inertia at "
                "eta 0.6, and a negative inertia above eta 1. Below eta_min of equation (25) the "
                "proposed coupling is not passive."}}};
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
