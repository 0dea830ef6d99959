// Two-port time-domain passivity (Ryu, Artigas and Preusche 2010; Artigas et al. 2011): the
// device's velocity goes to the proxy's side, the spring's force comes back.
//
// Each port books what goes in and what goes out; packets carry what went in. At the device a
// damper takes what came out beyond what the other side had taken in; at the proxy the velocity is
// lowered. With in2 as it came, D the motion in a tick and t_j the torques on their way,
//     S = in2 - out1 - sum_j (t_j.D)+ - (tau.D)+,  S < 0: tau1 = tau - alpha M1 v as in popc.h,
//     v = v_d + fix - beta F,  beta the least with T F.v <= in1 - out2.
// The device's own damping counts as taken in, which the published law does not know. fix takes
// drift back, a part of it in each tick, out of what is left (Artigas, Ryu and Preusche
// 2010; Chawda and O'Malley 2014; Coelho et al. 2018).
#pragma once

#include <array>
#include <memory>

#include "core/base/field.h"
#include "core/coupling/law_info.h"

namespace limpid {

struct TdpnLaw {
  static constexpr std::array kSliders{"coupling.k_vc", "coupling.b_vc", "coupling.b_v",
                                       "tdpn.damping",  "link.delay",    "link.jitter",
                                       "link.loss"};
  static constexpr LawInfo kInfo{
      .key = "tdpn",
      .label = "Two-port TDPA",
      .meaning =
          "sends the device's velocity to the proxy and a force back. A damper on each side keeps "
          "both sides passive (Ryu, Artigas and Preusche 2010).",
      .verdict = "Takes back most of the energy given. Device and proxy move apart (drift).",
      .promise = Promise::observer,
      .for_links = true,
      .for_comparison = true,
      .through_link =
          "dampers take back the energy that both sides gave; a longer delay makes walls softer",
      .damper_share =
          "100 % while the device's damper does not act, 0 % at the largest damper allowed",
      .sliders = kSliders,
  };

  struct Settings {
    double tdpn_damping = 1;   // c, largest damper of the device's side [M1/T]
    double tdpn_drift = 0.02;  // part of the drift taken back in a tick

    template <class P>
    static constexpr std::array<Field<P>, 2> settings() {
      return {{{"tdpn.damping", "TDPA's damper", "Largest damper of TDPA", &P::tdpn_damping, "M1/T",
                0.02, 1, 0.02, 1, false, true,
                "Two-port TDPA: largest damping of the device's damper, as a part of M1/T, divided "
                "by (1 + delay in ticks)."},
               {"tdpn.drift", "drift", "Drift taken back", &P::tdpn_drift, "-", 0, 0.2, 0, 0.2,
                false, true,
                "Two-port TDPA: part of the distance (drift) between device and proxy that the law "
                "removes in a tick, if enough energy is left."}}};
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
