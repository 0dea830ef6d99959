// Account of the energy that the human may still be given, and the governors that act when it runs
// low.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "core/coupling/cells.h"
#include "core/coupling/law_info.h"
#include "core/math/sizes.h"

namespace limpid {

// The part of the energy stored when an account begins that the human has not put in.
enum class Owed : std::uint8_t {
  nothing,
  growth,  // what there is more than the account last knew of
  all,
};

// Returns what is owed where a start follows one that was not used yet.
constexpr Owed after_unused(Owed unused, Owed next) {
  return unused == Owed::all && next == Owed::growth ? Owed::all : next;
}
// Returns the debt of a start at which so much is stored, `added` more than was known of [J].
constexpr double debt_of(Owed owed, double stored, double added) {
  return owed == Owed::all ? stored : owed == Owed::growth ? std::max(0.0, added) : 0;
}

// H = E - (energy stored in device and proxy). While H >= 0 the energy given at the human's port
// since the start is at most E0, beyond what came in and was dissipated. H is kept to at most four
// times E0: this much may be given in any part of the time.
//
// The motors' delay may be unknown. There is an account for every possible delay, and the least of
// them counts: one of them is the right one.
template <int N>
class Ledger {
 public:
  // Begins anew. left: reserve left by an earlier part of the run [J]; none: this ledger's own.
  // owed: what of the energy that is stored now the human has not put in.
  void start(const Vec<N>& y, std::optional<double> left, Owed owed) {
    owed_ = fresh_ ? after_unused(owed_, owed) : owed;
    if (left) {
      left_ = *left;
    } else if (!fresh_) {
      left_ = H_;
    }
    fresh_ = true;
    dy_ = dx_ = Vec<N>::Zero(y.size());
    let_through();
    on_its_way_ = 0;
    y_ = x_ = rests_at_ = y;
    rested_ = 0;
  }

  // Moves to the first reading after start().
  void begin_at(const Vec<N>& y) { y_ = x_ = rests_at_ = y; }
  // Lets everything through again, for another law.
  void let_through() { contact_ = damping_ = torque_ = 1; }

  // Sets the least and the largest delay between command and motor [ticks].
  void expect(int least, int most) {
    if (least == least_ && most == most_) return;
    E_.fill(E());
    least_ = least;
    most_ = most;
  }

  // Position of the device by its readings alone, y the newest [rad].
  Vec<N> located(const Vec<N>& y) const { return y - (y - y_) / 2; }
  // Books the tick just ended. y: the reading after it; x: the device's position as located; b_lo:
  // a safe lower bound of its damping; q: the encoders' step.
  // sent(d): torque sent d ticks before the last one [N m]. `given`: by the proxy to bodies of its
  // world, which have an account of their own [J].
  template <class Sent>
  void add(const Vec<N>& y, const Vec<N>& x, const Sent& sent, const Vec<N>& b_lo, double given,
           double q, double T) {
    dy_ = y - y_;
    y_ = y;
    const Vec<N> now = within_cells<N>(y, x - y, q);
    dx_ = now - x_;
    x_ = now;
    const double damped = sure_loss<N>(b_lo, dy_, q, T);
    for (int d = least_; d <= most_; ++d) at(d) += damped - sent(d).dot(dx_) - given;
    on_its_way_ = 0;
    for (int d = 0; d < most_; ++d) on_its_way_ += std::max(0.0, sent(d).dot(dx_));
  }

  // Takes the energy that is stored now [J]. The first one is a debt where it is owed; so is its
  // growth while no torque reaches the motors, against which nobody had to push.
  void settle(double E0, double stored) {
    E0_ = E0;
    const double added = stored - std::exchange(stored_, stored);
    if (fresh_) {
      H_ = std::min(E0, left_) - debt_of(owed_, stored, added);
      E_.fill(H_ + stored);
      fresh_ = false;
      return;
    }
    for (int d = least_; d <= most_; ++d) at(d) = std::min(at(d), kCap * E0 + stored);
    H_ = E() - stored;
  }
  // After settle(): gives the hand E0 anew, when force has been requested. Until then no motor
  // pushed, so what is stored is a debt.
  void refill() {
    H_ = E0_ - stored_;
    E_.fill(E0_);
  }

  // After settle(), for a device whose damping is not sure. The damping took energy from the hand
  // that no book shows, a debt that a hand at rest could never pay. So up to E0 of it is forgiven
  // for each half second that the hand holds still. q: the encoders' step [rad].
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
    add(owed);
  }
  // After settle(): forgives what a law that keeps no account gave below `least` [E0]. before: the
  // reserve before the tick [J].
  void forgive(double before, double least) {
    add(std::max(0.0, std::min(before, least * E0_) - H_));
  }

  // Updates the shares. `slip`: error of the last prediction [rad]; f2: the last contact torque;
  // `surprise`: largest unforeseen change of the device's velocity in a tick [rad/s].
  void govern(const Vec<N>& f2, const Vec<N>& slip, double surprise, double T) {
    const Vec<N> off = 2 * slip.cwiseAbs() + 0.1 * dy_.cwiseAbs();
    const double leak = f2.cwiseAbs().dot(off) + T * surprise * f2.norm();
    follow(leak > 0 ? H_ / leak : 1, T / 0.05, contact_);
    follow((H_ / E0_ - kNone) / (kWhole - kNone), T / 0.2, damping_);
    follow(((E() - on_its_way_) / E0_ - kGone) / (kNone - kGone), T / 0.2, torque_);
  }

  // Reserve H [J]; before the first tick as left by an earlier part, infinite if there was none.
  double reserve() const { return fresh_ ? left_ : H_; }
  double contact() const { return contact_; }  // g_f: share of f2 that reaches the hand, 0 to 1
  // g_b: share of the damping cancelled and of the inertia added, 0 to 1.
  double damping() const { return damping_; }
  // Share of all torque: ends what nothing else stops, such as a late damper in a stiff hand that
  // does not damp. It follows the energy given, not stored: a hand that holds still in a wall keeps
  // its force.
  double torque() const { return torque_; }
  // Motion of the device along a path within the cells of the readings, without their jumps: a jump
  // would be work that no torque has done [rad].
  const Vec<N>& dx() const { return dx_; }

  // Least reserve of a hand at rest, in E0: enough for all force but not for g_b.
  static constexpr double kForgiven = 0.4;

 private:
  // Levels of H, in E0. kCap: the most it may be, as a heavy arm on a wall needs, else small
  // prediction errors would cut the force. kWhole and kNone: g_b is 1 and 0; kGone: all torque is
  // 0.
  static constexpr double kCap = 4, kWhole = 0.8, kNone = 0.35, kGone = 0.25;
  static constexpr double kRest = 0.5, kStill = 5e-4;  // duration and bound of rest [s, rad]

  // Moves g to `target`: down at once, up slowly.
  static void follow(double target, double rate, double& g) {
    target = std::clamp(target, 0.0, 1.0);
    g = target < g ? target : g + std::min(rate, 1.0) * (target - g);
  }
  void add(double energy) {
    H_ += energy;
    for (int d = least_; d <= most_; ++d) at(d) += energy;
  }
  double& at(int delay) { return E_[static_cast<std::size_t>(delay)]; }
  double E() const { return *std::min_element(E_.begin() + least_, E_.begin() + most_ + 1); }

  bool fresh_ = true;
  Owed owed_ = Owed::nothing;
  int least_ = 0, most_ = 0;
  std::array<double, kMostDelay + 1> E_{};  // by delay [J]
  double E0_ = 0, stored_ = 0, on_its_way_ = 0;
  double H_ = std::numeric_limits<double>::infinity(), left_ = H_;
  double contact_ = 1, damping_ = 1, torque_ = 1;
  double rested_ = 0;  // time at rest at rests_at_ [s]
  Vec<N> y_, dy_, x_, dx_, rests_at_;
};

}  // namespace limpid
