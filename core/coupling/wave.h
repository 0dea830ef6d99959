// Wave variables between device and proxy (Niemeyer and Slotine 1991, 2004), as sums that are
// played out evenly (after Niemeyer and Slotine 1998). The cut of the energy is this program's.
//
// With the impedance b of the line and r = sqrt(2 b) the device feels tau1 = -b v1 + r w, and
// beside it a damper b that matches the line. After a tick with the motion D, in which a acted, the
// wave
//     u = r D/T - w,  cut so that T u.u/2 is at most what came in: T w.w/2 - (a + b v1).D - debt
// leaves for the proxy's side. There
//     F2 = k_vc (x_d - x2) + b (v_d - v2),  v_d = (r u - F2)/b,  and w = u - r F2/b goes back.
// Packets carry the sums of u T and of u.u T/2. They are played out link.delay + link.jitter ticks
// after they were sent, with packets lost a little later, and never with more energy than came.
// Both dampers are held for a tick, whose debt the device's own b_d pays: 3 b <= b_d pays for any
// motion (2 b without the matching damper), and then device and proxy are given nothing at any
// delay. A hand that turns round in each tick is given energy from 2 b > b_d on. A wall K is felt
// as 1/(1/K + 1/k_vc + (t_l + T/2)/b), t_l the delay. b = b_v is matched on both sides: no mass of
// the line is felt.
#pragma once

#include <array>
#include <limits>
#include <memory>

#include "core/base/field.h"
#include "core/coupling/law_info.h"

namespace limpid {

struct WaveLaw {
  static constexpr std::array kSliders{"coupling.k_vc", "coupling.b_v", "link.delay", "link.jitter",
                                       "link.loss"};
  static constexpr LawInfo kInfo{
      .key = "wave",
      .label = "Wave variables",
      .meaning =
          "waves on a line connect device and proxy, at any delay (Niemeyer and Slotine 1991).",
      .verdict = "Stable at any delay. Walls feel no stiffer than the wave line.",
      .promise = Promise::line,
      .for_links = true,
      .for_comparison = true,
      .through_link = "delay, jitter and loss add no energy",
      .sliders = kSliders,
  };

  struct Settings {
    // b; NaN, which stands for b_v [N m s/rad].
    double wave_b = std::numeric_limits<double>::quiet_NaN();
    bool wave_matched = true;

    template <class P>
    static constexpr std::array<Field<P>, 2> settings() {
      return {
          {{"wave.b", "line b", "Wave impedance b", &P::wave_b, "N m s/rad", 1e-5, 10, 1e-3, 0.1,
            true, true,
            "Wave variables: impedance b of the line. Default: b_v, so that the proxy's damper "
            "matches the line. With a larger b walls feel stiffer if there is a delay, and free "
            "motion is damped more."},
           {"wave.matched", "matched", "Line matched at the device", &P::wave_matched, "-", 0, 1, 0,
            1, false, true,
            "Wave variables: a damper b at the device absorbs the waves that come back. Off: "
            "the device reflects these waves."}}};
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
