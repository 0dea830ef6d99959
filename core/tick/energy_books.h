// The paper's controller energy E_c, kept twice.
#pragma once

#include "core/math/sizes.h"

namespace limpid {

// E_c = sum over ticks of tau1 . dx1 + tau2 . dx2. Commanded: motors and proxy, what instruments
// see. Total: with the device's own damping, -b_d/T dx1 . dx1 a tick.
template <int N>
struct EnergyBooks {
  double commanded = 0;     // [J]
  double total = 0;         // [J]
  double port = 0;          // of motors and own damping alone: what the human was given [J]
  double compensation = 0;  // of commanded, what the motors gave for the device's own forces [J]
  double contact = 0;       // work of the contacts on the proxy [J]

  // tau1 the motor torque held over the tick, dx the motion over it, b_d the device's damping.
  void add(const Vec<N>& tau1, const Vec<N>& dx1, const Vec<N>& tau2, const Vec<N>& dx2,
           const Vec<N>& b_d, double T) {
    const double work = tau1.dot(dx1) + tau2.dot(dx2);
    const double damped = b_d.cwiseProduct(dx1).dot(dx1) / T;
    commanded += work;
    total += work - damped;
    port += tau1.dot(dx1) - damped;
  }

  // A contact is a spring: what it gave and still stores comes to nothing while it lasts. Making
  // and breaking it within a tick, and slipping, leave something over.
  void add_contact(const Vec<N>& f2, const Vec<N>& dx2) { contact += f2.dot(dx2); }
  double contact_gain(double stored, double stored_at_first) const {
    return contact + stored - stored_at_first;
  }
};

}  // namespace limpid
