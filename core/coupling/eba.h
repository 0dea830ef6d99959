// Energy bounding on the device itself, after Kim and Ryu (2010, IJRR 29, 666) in the least
// conservative form for several joints, which is rebuilt here from what is public.
//
// The walls' torque tau_e is let through as far as an account E can pay for the coming tick. E
// grows by what the device's damping b takes, and by what the hand puts in. With B = b/T, D_k the
// motion in a tick, a_k the torque that acted in it and t_j the torques on their way,
//     E_k = E_k-1 + D_k.B D_k - a_k.D_k,
//     tau1 = s tau_e,  s <= 1 the largest with
//         s^2 tau_e.B^-1 tau_e / 4 <= E_k - sum_j t_j.B^-1 t_j / 4.
// In a tick D.B D - t.D >= -t.B^-1 t / 4, however the hand moves. So E >= 0 for ever, at any delay.
#pragma once

#include <array>
#include <limits>
#include <memory>

#include "core/base/field.h"
#include "core/coupling/law_info.h"

namespace limpid {

struct EbaLaw {
  static constexpr std::array<const char*, 0> kSliders{};
  static constexpr LawInfo kInfo{
      .key = "eba",
      .label = "Energy bounding",
      .meaning =
          "without a proxy: walls act on the device itself. The law limits their force so that the "
          "device's damping dissipates the energy (Kim and Ryu 2010).",
      .verdict = "Passive in every hand. Walls are soft where the arm has little damping.",
      .promise = Promise::port,
      .on_device = true,
      .for_comparison = true,
      .through_link = "the law renders walls on the device itself and has no link",
      .torque_share =
          "Share of the walls' torque that the energy account allows in the coming tick. If the "
          "hand presses a wall when this law is switched on, the wall's force comes back while the "
          "hand presses further.",
      .sliders = kSliders,
  };

  struct Settings {
    // b of every joint; NaN, which stands for the device's own as it is known [N m s/rad].
    double eba_damping = std::numeric_limits<double>::quiet_NaN();

    template <class P>
    static constexpr std::array<Field<P>, 1> settings() {
      return {{{"eba.damping", "b bounded by", "Assumed damping", &P::eba_damping, "N m s/rad", 0,
                10, 0, 0.1, false, true,
                "Energy bounding: damping that the law assumes in every joint. From this damping "
                "the law computes the largest torque of the walls. Default: the device's own "
                "damping, identified or given by its file. If the value is above the true damping, "
                "the hand gets energy. For a real device Limpid uses at most the known damping."}}};
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
