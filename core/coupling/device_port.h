// The device's port, as laws without a model of the device book it: its motion in the tick that
// ended, the torques that left, and a damper for what was given.
#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include "core/coupling/cells.h"
#include "core/coupling/law.h"
#include "core/coupling/law_info.h"

namespace limpid {

template <int N>
class DevicePort {
 public:
  void start(const Vec<N>& x1) {
    x1_ = x1;
    first_ = true;
    elapsed_ = 0;
    sent_.fill(Vec<N>::Zero(x1.size()));
  }
  // Takes the time since the previous reading [s].
  void wait(double elapsed) { elapsed_ = elapsed; }
  // Takes a reading. True if a tick ended with it.
  bool read(const LawInput<N>& in) {
    D_ = in.x1 - x1_;
    x1_ = in.x1;
    q_ = in.encoder_step;
    return !std::exchange(first_, false) && elapsed_ > 0;
  }
  void applied(const Vec<N>& torque) {
    std::rotate(sent_.begin(), sent_.end() - 1, sent_.end());
    sent_[0] = torque;
  }

  double elapsed() const { return elapsed_; }
  const Vec<N>& D() const { return D_; }  // motion in the tick that ended [rad]
  // Torque that left so many ticks before the last one [N m].
  const Vec<N>& sent(int ticks) const { return sent_[static_cast<std::size_t>(ticks)]; }
  // Energy that dampers b took in the tick that ended [J].
  double damped(const Vec<N>& b) const { return sure_loss<N>(b, D_, q_, elapsed_); }
  // Motion that is more than a step of the encoder [rad].
  Vec<N> moved() const { return (D_.array().abs() > 1.5 * q_).select(D_, 0); }

  // Part of the largest damper, 0 to 1, and the torque of it: alpha M1 v takes S < 0 back, alpha at
  // most c/(T (1 + delay)).
  struct Brake {
    double part = 0;
    Vec<N> torque;  // [N m]
  };
  Brake brake(double S, double c, int delay, const LawInput<N>& in) const {
    const Vec<N> motion = moved(), momentum = in.device.M * motion;
    const double action = momentum.dot(motion);  // T^2 v.M1 v
    if (!(S < 0) || !(action > 0)) return {0, Vec<N>::Zero(motion.size())};
    const double T = in.tick, most = c / (T * (1 + delay));
    const double alpha = std::min(-S * T / action, most);
    return {alpha / most, alpha / T * momentum};
  }

 private:
  bool first_ = true;
  double elapsed_ = 0;  // [s]
  double q_ = 0;        // [rad]
  Vec<N> x1_, D_;
  std::array<Vec<N>, kMostDelay + 1> sent_;  // the last one first
};

}  // namespace limpid
