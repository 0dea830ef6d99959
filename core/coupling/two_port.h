// A coupling as a two-port between the hand at the device and the contacts at the proxy, and
// Llewellyn's criterion on it: whether any passive hand on any passive contact is stable.
//
// The ports have the torque that is put in and the mean velocity over a tick, of a joint; inertias
// are left out, as they store energy and make none. The torque of the device is held over a tick.
#pragma once

#include <complex>
#include <functional>
#include <optional>

#include "core/coupling/spring_damper.h"

namespace limpid {

// A two-port at a frequency, by what the criterion asks of its matrix, impedance or hybrid.
struct TwoPort {
  std::complex<double> one, two;  // on the diagonal
  std::complex<double> across;    // product of the other two
};

// Joint between hand and contact, as the loop samples it.
struct SampledJoint {
  double b_d = 0;    // damping of the device [N m s/rad]
  double T = 0.001;  // [s]
  int delay = 0;     // of the device's torque [ticks]
  int link = 0;      // delay between the sides, each way [ticks]
};

// Spring and damper, (1)-(2), at f [Hz], above 0 and up to 1/(2 T).
TwoPort spring_two_port(const SpringDamper& gains, const SampledJoint& joint, double f);
// Contacts on the device itself: the proxy goes where the last reading was.
TwoPort device_two_port(const SampledJoint& joint, double f);

// Stability parameter of Llewellyn's criterion: 2 Re Z11 Re Z22/|Z12 Z21| - cos arg(Z12 Z21). The
// two-port is absolutely stable where it is at least 1; it is less where an impedance of the
// diagonal gives energy. Infinite where nothing comes across.
double llewellyn(const TwoPort& p);

// Llewellyn's criterion over all frequencies up to half the loop's rate.
struct Llewellyn {
  double least;                      // of the parameter
  double frequency;                  // at which it is least [Hz]
  std::optional<double> fails_from;  // lowest frequency at which it fails [Hz]
};
Llewellyn llewellyn(const std::function<TwoPort(double)>& two_port, double T);

}  // namespace limpid
