// Successive force augmentation on the device itself, after Singh, Janetzko, Jafari, Weber, Lee and
// Ryu (2020, T-IE 67, 809). The rule of the increments, and those at rest, are this program's: the
// paper's text was not read. What is measured here says nothing of the paper's rule.
//
// Walls are soft, and a force o is added until they push as they should; with `sfa.extended` they
// push in full until the hand first turns back or rests. With tau_e the walls'
// torque, f its size, U what the walls store, B the device's damping b_d, and
//     kappa = min(1, rho 2 U/((T/2 + delay) tau_e.B^-1 tau_e)),
// so that kappa K of a wall K at the tip is at most rho b_n/(T/2 + delay), b_n the damping there:
//     tau1 = (kappa f + o) tau_e/f,   o = max(0, o + sigma kappa (f* - (kappa f* + o))),
// where pressing turns into letting go (f* the largest f), and each 20 ticks at rest (f* = f). At
// rest in a grip k_h each update leaves 1 - sigma K_r (K + k_h)/(K (K_r + k_h)) of what is missing,
// K_r = kappa K. Once the wall is left o is 0. The increments give energy: nothing is promised.
#pragma once

#include <array>
#include <memory>

#include "core/base/field.h"
#include "core/coupling/law_info.h"

namespace limpid {

struct SfaLaw {
  static constexpr std::array kSliders{"sfa.soft", "sfa.step"};
  static constexpr LawInfo kInfo{
      .key = "sfa",
      .label = "Augmentation",
      .meaning =
          "without a proxy: soft walls act on the device itself. While they are pressed, their "
          "force grows up to the correct force (successive force augmentation, Singh and others "
          "2020).",
      .verdict = "Walls become stiff while they are pressed. This gives energy to the hand.",
      .promise = Promise::none,
      .on_device = true,
      .for_comparison = true,
      .through_link = "the law renders walls on the device itself and has no link",
      .torque_share = "Share of the walls' full torque that the law has reached.",
      .sliders = kSliders,
  };

  struct Settings {
    double sfa_soft = 0.5;     // rho
    double sfa_step = 0.5;     // sigma
    bool sfa_extended = true;  // the walls as they are, until pressing first turns

    template <class P>
    static constexpr std::array<Field<P>, 3> settings() {
      return {{{"sfa.soft", "soft spring rho", "Stiffness at the start", &P::sfa_soft, "-", 0.05, 1,
                0.05, 1, false, true,
                "Augmentation: stiffness at the start, divided by b_d/(T/2 + delay), the largest "
                "stiffness that is stable in every hand."},
               {"sfa.step", "step sigma", "Part added at a time", &P::sfa_step, "-", 0.01, 1, 0.01,
                1, false, true,
                "Augmentation: part of the missing force that one increment adds if the hand does "
                "not move."},
               {"sfa.extended", "extended", "Start with full stiffness", &P::sfa_extended, "-", 0,
                1, 0, 1, false, true,
                "Augmentation. On: a wall pushes with its full stiffness until the hand first "
                "moves back or rests. After that the wall is soft, and its force grows step by "
                "step. Off: the wall is soft from the start."}}};
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
