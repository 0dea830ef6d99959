// Account of the energy that the human may still be given, and the governors that act when it runs
// low.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "core/coupling/laws.h"
#include "core/math/sizes.h"

namespace limpid {

// H = E - (what device and proxy have stored): while H >= 0 the energy given at the human's port is
// at most E0 since the start, on top of what came in and was dissipated. Of that no more is kept
// than makes H four times E0: so much may be given in any part of the time.
//
// How late the motors give a torque may not be known. There is an account for every delay that is
// possible, and the least of them is the one that counts: one of them is right, whichever it is.
template <int N>
class Ledger {
 public:
  // The reserve that is left of an earlier part of the run [J]; none given: as it was here.
  void start(const Vec<N>& y, std::optional<double> left) {
    if (left) {
      left_ = *left;
    } else if (!fresh_) {
      left_ = H_;
    }
    fresh_ = true;
    dy_ = dx_ = Vec<N>::Zero(y.size());
    contact_ = damping_ = torque_ = 1;
    still_.fill(0);
    on_its_way_ = 0;
    y_ = x_ = rests_at_ = y;
    rested_ = 0;
  }

  // Of the delays between command and motor, the least and the most [ticks].
  void expect(int least, int most) {
    if (least == least_ && most == most_) return;
    E_.fill(E());
    least_ = least;
    most_ = most;
  }

  // The tick just ended: the reading y after it, where the device is thought to be (x), a safe
  // lower bound b_lo of the device's damping. q: the encoders' step; a reading that does not change
  // says nothing. sent(d): the torque that was sent d ticks before the last one [N m]. `given`: by
  // the proxy to what moves in its world, which has an account of its own [J].
  template <class Sent>
  void add(const Vec<N>& y, const Vec<N>& x, const Sent& sent, const Vec<N>& b_lo, double given,
           double q, double T) {
    dy_ = y - y_;
    y_ = y;
    const Vec<N> now = y + (x - y).cwiseMin(q / 2).cwiseMax(-q / 2);
    dx_ = now - x_;
    x_ = now;
    double damped = 0;
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      int& n = still_[static_cast<std::size_t>(i)];
      ++n;
      if (q > 0 && dy_[i] == 0) continue;
      damped += b_lo[i] * dy_[i] * dy_[i] / (n * T);
      n = 0;
    }
    for (int d = least_; d <= most_; ++d) at(d) += damped - sent(d).dot(dx_) - given;
    on_its_way_ = 0;
    for (int d = 0; d < most_; ++d) on_its_way_ += std::max(0.0, sent(d).dot(dx_));
  }

  // Takes the energy that is stored now [J]. At first that is nobody's debt, nor is its growth
  // while no torque leaves for the motors (idle): the hand alone brought it there.
  void settle(double E0, double stored, bool idle = false) {
    E0_ = E0;
    const double added = stored - std::exchange(stored_, stored);
    if (fresh_) {
      H_ = std::min(E0, left_);
      E_.fill(H_ + stored);
      fresh_ = false;
      return;
    }
    for (int d = least_; d <= most_; ++d) {
      if (idle) at(d) += added;
      at(d) = std::min(at(d), kCap * E0 + stored);
    }
    H_ = E() - stored;
  }
  // After settle(): somebody has decided that the hand may be given E0 from here on.
  void refill() {
    H_ = E0_;
    E_.fill(E0_ + stored_);
  }

  // After settle(), for a device whose damping is not sure. The damping took energy from the hand
  // that stands in no book, and a hand that holds still could never pay that debt. So it is
  // forgiven, up to E0 for each half second that the hand holds still. q: the encoders' step [rad].
  void forgive_at_rest(double q, double T) {
    const double within = std::max(kStill, 1.5 * q);
    rested_ += T;
    if (!((y_ - rests_at_).cwiseAbs().maxCoeff() <= within)) {
      rests_at_ = y_;
      rested_ = 0;
    }
    const double owed = std::min(kForgiven * E0_ - H_, E0_);
    if (rested_ < kRest || !(owed > 0)) return;
    rested_ = 0;
    H_ += owed;
    for (int d = least_; d <= most_; ++d) at(d) += owed;
  }

  // `slip`: how far the last prediction was off [rad], f2 the last contact torque, `surprise` by
  // how much a tick may change the device's velocity unforeseen [rad/s].
  void govern(const Vec<N>& f2, const Vec<N>& slip, double surprise, double T) {
    const Vec<N> off = 2 * slip.cwiseAbs() + 0.1 * dy_.cwiseAbs();
    const double leak = f2.cwiseAbs().dot(off) + T * surprise * f2.norm();
    follow(leak > 0 ? H_ / leak : 1, T / 0.05, contact_);
    follow((H_ / E0_ - kNone) / (kWhole - kNone), T / 0.2, damping_);
    follow(((E() - on_its_way_) / E0_ - kGone) / (kNone - kGone), T / 0.2, torque_);
  }

  // [J]; before its first tick what it may start with, infinite if it never had one.
  double reserve() const { return fresh_ ? left_ : H_; }
  double contact() const { return contact_; }  // g_f: share of f2 that reaches the hand, 0 to 1
  // g_b: share of the damping cancelled and of the inertia added, 0 to 1.
  double damping() const { return damping_; }
  // Share of all torque: what nothing else stops, as a late damper in a stiff hand that does not
  // damp, ends there. It follows what was given, not what is stored: a hand that holds still in a
  // wall keeps its force.
  double torque() const { return torque_; }
  // How the device moved, along a path within the cells of the readings that does not jump as they
  // do: a jump would be work that no torque has done [rad].
  const Vec<N>& dx() const { return dx_; }

 private:
  // Of E0: the most that H may be, as a heavy arm on a wall asks for, or the force would be cut
  // where the prediction is off by a little; where g_b is 1 and where 0, and all torque 0.
  static constexpr double kCap = 4, kWhole = 0.8, kNone = 0.35, kGone = 0.25;
  // The least that a hand at rest has, of E0: enough for all force but not for g_b.
  static constexpr double kForgiven = 0.4;
  static constexpr double kRest = 0.5, kStill = 5e-4;  // how long, and how still that is [s, rad]

  // At once down, slowly up.
  static void follow(double target, double rate, double& g) {
    target = std::clamp(target, 0.0, 1.0);
    g = target < g ? target : g + std::min(rate, 1.0) * (target - g);
  }
  double& at(int delay) { return E_[static_cast<std::size_t>(delay)]; }
  double E() const { return *std::min_element(E_.begin() + least_, E_.begin() + most_ + 1); }

  bool fresh_ = true;
  int least_ = 0, most_ = 0;
  std::array<double, kMostDelay + 1> E_{};  // by the delay [J]
  double E0_ = 0, stored_ = 0, on_its_way_ = 0;
  double H_ = std::numeric_limits<double>::infinity(), left_ = H_;
  double contact_ = 1, damping_ = 1, torque_ = 1;
  std::array<int, kMaxDof> still_{};
  double rested_ = 0;  // it has, at rests_at_ [s]
  Vec<N> y_, dy_, x_, dx_, rests_at_;
};

}  // namespace limpid
