// Passivity observer and controller on the device itself (Hannaford and Ryu 2002), with mends of
// others and of this program.
//
// W is what came in at the device's port, U what the walls store at the reading, B = b/T, D_k the
// motion in a tick, a_k the torque that was held in it, t_j the torques on their way, d the delay:
//     W_k = W_k-1 - a_k.D_k + D_k.B D_k,
//     S = W_k - U + (d tau_e - sum_j t_j).D_k - (d + 1)^2/2 D_k.K_c D_k,
//     tau1 = tau_e - alpha M1 v,  alpha = min(-S/(T v.M1 v), c/(T (1 + d))) where S < 0.
// The held torque in W: Ryu, Kim and Hannaford (2004, T-RO 20, 772). U as reference energy, so that
// the damper acts within the first bounce: Ryu, Preusche, Hannaford and Hirzinger (2005, T-CST 13,
// 737). This program's own: S is foretold for when the torque acts. Motions below 1.5 steps of the
// encoder are none. The damper is bounded, as without bound it diverges on light devices. M1 v
// instead of v keeps it from turning the motion of several joints.
#pragma once

#include <array>
#include <limits>
#include <memory>

#include "core/base/field.h"
#include "core/coupling/law_info.h"

namespace limpid {

struct PopcLaw {
  static constexpr std::array kSliders{"popc.damping"};
  static constexpr LawInfo kInfo{
      .key = "popc",
      .label = "PO/PC",
      .meaning =
          "without a proxy: walls act on the device itself, with a damper that takes back the "
          "energy the walls gave (passivity observer and controller, Hannaford and Ryu 2002).",
      .verdict = "Takes back most of the energy that walls gave. Coarse encoders cause errors.",
      .promise = Promise::observer,
      .on_device = true,
      .for_comparison = true,
      .through_link = "the law renders walls on the device itself and has no link",
      .damper_share = "100 % without a damper, 0 % at the largest damper allowed",
      .sliders = kSliders,
  };

  struct Settings {
    double popc_damping = 0.5;   // c, largest damper [M1/T]
    bool popc_reference = true;  // U is the reference, not 0

    template <class P>
    static constexpr std::array<Field<P>, 2> settings() {
      return {
          {{"popc.damping", "PC's damper", "Largest damper of PO/PC", &P::popc_damping, "M1/T",
            0.02, 1, 0.02, 1, false, true,
            "PO/PC: largest damping of the law's damper, as a part of M1/T, divided by (1 + "
            "delay in ticks)."},
           {"popc.reference", "reference", "Reference energy", &P::popc_reference, "-", 0, 1, 0, 1,
            false, true,
            "PO/PC: the damper acts if the energy that came in is less than the energy that "
            "the walls store. Off: the damper acts if the energy that came in is less than zero "
            "(the law of 2002). Then a bounce first uses up the stored energy, and the damper "
            "acts later."}}};
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
