// Account of the energy that the human may still be given, and the governors that act when it runs
// low.
#pragma once

#include <algorithm>
#include <array>

#include "core/math/sizes.h"

namespace limpid {

// H = E - (what device and proxy have stored): while H >= 0 the energy given at the human's port is
// at most E0, and what was dissipated since, of which no more than kCap is kept.
template <int N>
class Ledger {
 public:
  void start(const Vec<N>& y) {
    E_ = H_ = 0;
    fresh_ = true;
    dy_ = dx_ = Vec<N>::Zero(y.size());
    contact_ = damping_ = 1;
    still_.fill(0);
    y_ = x_ = y;
  }

  // The tick just ended: the reading y after it, where the device is thought to be (x), the torque
  // tau that acted, a safe lower bound b_lo of the device's damping. q: the encoders' step; a
  // reading that does not change says nothing.
  void add(const Vec<N>& y, const Vec<N>& x, const Vec<N>& tau, const Vec<N>& b_lo, double q,
           double T) {
    dy_ = y - y_;
    y_ = y;
    const Vec<N> now = y + (x - y).cwiseMin(q / 2).cwiseMax(-q / 2);
    dx_ = now - x_;
    x_ = now;
    E_ -= tau.dot(dx_);
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      int& n = still_[static_cast<std::size_t>(i)];
      ++n;
      if (q > 0 && dy_[i] == 0) continue;
      E_ += b_lo[i] * dy_[i] * dy_[i] / (n * T);
      n = 0;
    }
  }

  // What is stored meanwhile [J]. At first that is nobody's debt, and E0 is there to give.
  void settle(double E0, double stored) {
    if (fresh_) E_ = E0 + stored;
    fresh_ = false;
    H_ = E_ - stored;
    const double over = H_ - kCap;
    if (over > 0) {
      H_ = kCap;
      E_ -= over;
    }
  }

  // `slip`: how far the last prediction was off [rad], f2 the last contact torque.
  void govern(const Vec<N>& f2, const Vec<N>& slip, double T) {
    const double speed = 0.1 * dy_.norm() / T + kSurprise;
    const double leak = f2.norm() * (2 * slip.norm() + T * speed);
    follow(leak > 0 ? H_ / leak : 1, T / 0.05, contact_);
    follow((H_ - 1e-3) / 3e-3, T / 0.2, damping_);
  }

  double reserve() const { return H_; }        // [J]
  double contact() const { return contact_; }  // g_f: share of f2 that reaches the hand, 0 to 1
  double damping() const { return damping_; }  // g_b: share of the damping cancelled, 0 to 1
  // How the device moved, along a path within the cells of the readings that does not jump as they
  // do: a jump would be work that no torque has done [rad].
  const Vec<N>& dx() const { return dx_; }

 private:
  static constexpr double kCap = 0.02;      // [J]
  static constexpr double kSurprise = 0.5;  // change of velocity in a tick [rad/s]

  // At once down, slowly up.
  static void follow(double target, double rate, double& g) {
    target = std::clamp(target, 0.0, 1.0);
    g = target < g ? target : g + std::min(rate, 1.0) * (target - g);
  }

  bool fresh_ = true;
  double E_ = 0, H_ = 0, contact_ = 1, damping_ = 1;
  std::array<int, kMaxDof> still_{};
  Vec<N> y_, dy_, x_, dx_;
};

}  // namespace limpid
