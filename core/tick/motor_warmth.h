// Warmth of the motors by a model of first order, and the torque that it leaves them.
#pragma once

#include <span>

#include "core/dynamics/arm.h"

namespace limpid {

// Warmth from which people are told of it, and from which a motor's torque is limited [-].
inline constexpr double kWarmFrom = 0.5;

// Largest torque of a motor at this warmth [N m]: `peak` up to kWarmFrom, from there on falling to
// `continuous` at 1. Its square falls in a straight line, as it is the square that heats.
// `continuous`: 0 if it is not known, which limits nothing.
double warm_limit(double peak, double continuous, double warmth);

// Warmth of each motor, from 0 cold to 1 as warm as it may be. Torque tau heats it towards
// (tau / continuous)^2 with the motor's time constant, so its continuous torque takes it to 1 and
// never beyond. At the limit above the warmth reaches 1 but in infinite time, whatever is asked of
// the motor. A motor whose continuous torque is not known stays cold.
template <int N>
class MotorWarmth {
 public:
  // Longest time for which motors hold a torque that nobody renews: the device's own thread takes
  // it away within 8.3 ms [s].
  static constexpr double kHeld = 0.01;

  explicit MotorWarmth(const ArmDescription& arm);

  // Begins at this warmth of each motor. Motors are cold where it is missing or no number.
  void start(std::span<const double> warmth);
  // Passes a time [s] in which the motors hold `tau`.
  void hold(const Vec<N>& tau, double time);
  // Sets what the device says of its hottest motor; which one that is, it does not say.
  void report(double warmth) { reported_ = warmth; }

  const Vec<N>& modelled() const { return warmth_; }
  // The larger one of what is modelled and what the device says, of each motor.
  Vec<N> known() const { return warmth_.cwiseMax(reported_); }
  // Lowers limits of torque to what the warmth leaves [N m].
  void limit(Vec<N>& limits) const;

 private:
  bool any_;                  // motor whose continuous torque is known
  Vec<N> continuous_, time_;  // [N m, s]
  Vec<N> warmth_, share_;     // share of the way to its goal that a motor goes in `step_`
  double step_ = 0;           // [s]
  double reported_ = 0;
};

extern template class MotorWarmth<3>;
extern template class MotorWarmth<7>;
extern template class MotorWarmth<kAnyDof>;

}  // namespace limpid
