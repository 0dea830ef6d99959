// The law of most programs: walls on the device itself, each a spring. On one face, in right-angled
// corners and on meshes the force is that of a god-object (Zilles and Salisbury 1995; Ruspini,
// Kolarov and Khatib 1997). Unlike there the proxy sinks in with the reading, and oblique planes
// add up.
//
// A torque held for a tick, and late, gives energy: a wall K is passive in every hand up to
// K = 2 b_d/T (Colgate and Schenkel 1997), and quiet in a hand that damps with b_h up to
// (b_d + b_h)/(T/2 + delay) (Gil, Sanchez, Hulin, Preusche and Hirzinger 2009), where delay and
// damping are small.
#pragma once

#include <array>
#include <limits>
#include <memory>

#include "core/base/field.h"
#include "core/coupling/law_info.h"

namespace limpid {

struct DirectLaw {
  static constexpr std::array<const char*, 0> kSliders{};
  static constexpr LawInfo kInfo{
      .key = "direct",
      .label = "Direct",
      .meaning = "without a proxy: the walls' springs act on the device itself.",
      .verdict = "Most programs use this law. Stiff walls need a hand that damps enough.",
      .promise = Promise::none,
      .loop = LinearLoop::on_device,
      .on_device = true,
      .for_comparison = true,
      .through_link = "the law renders walls on the device itself and has no link",
      .sliders = kSliders,
  };

  struct Settings {
    template <class P>
    static constexpr std::array<Field<P>, 0> settings() {
      return {};
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
