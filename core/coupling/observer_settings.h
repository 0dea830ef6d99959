// Settings of the human force observer, see force_observer.h.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/field.h"

namespace limpid {

enum class VelocitySource : std::uint8_t { raw, lowpass, adaptive };
inline constexpr std::array kVelocitySources{"raw", "lowpass", "adaptive"};

struct ObserverSettings {
  double alpha = 0.035;  // [N m s/rad]
  bool anti_windup = true;
  VelocitySource velocity = VelocitySource::raw;

  template <class P>
  static constexpr std::array<Field<P>, 3> settings() {
    return {{{"observer.alpha", "\xCE\xB1", "Observer gain \xCE\xB1", &P::alpha, "N m s/rad", 1e-6,
              1e3, 1e-3, 1, true, true,
              "Gain of the human force observer, L = alpha M^-1, equations (17)-(18). With a "
              "larger gain the estimate follows the hand's force faster (w_f = alpha / m), and "
              "eta_min is higher."},
             {"observer.anti_windup", "anti-windup", "Observer knows the motors' limit",
              &P::anti_windup, "-", 0, 1, 0, 1, false, true,
              "Give the observer the torque that the motors really gave (section 3.1). Without it "
              "the estimate grows too large while motors are at their limit in contact, and the "
              "proxy stays behind when the hand moves back."},
             {"observer.velocity", "velocity", "Velocity estimate",
              choice<P, &P::velocity>(kVelocitySources), "-", 0, 2, 0, 2, false, true,
              "Velocity estimate: raw difference of positions, low-pass, or adaptive window "
              "(for coarse encoders)."}}};
  }
};

}  // namespace limpid
