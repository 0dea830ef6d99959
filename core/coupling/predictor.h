// Estimate of the device's state and of the hand's torque, from encoders and applied torque: a
// model of the device stepped ahead a tick at a time, corrected by each reading.
#pragma once

#include <array>
#include <cmath>

#include "core/coupling/encoder_filter.h"
#include "core/coupling/predictive.h"
#include "core/math/elementary.h"
#include "core/math/solve.h"

namespace limpid {

// Bounds of an arm's tip over all directions n.
struct TipMoved {
  double mass;   // at most 1 / (n' J M^-1 J' n) [kg]
  double lever;  // at least |J' n| [m]
};
// Bounds by mobility J M^-1 J' and levers J J'.
TipMoved tip_moved(const Mat3& mobility, const Mat3& levers);

// Jump of the velocity when an encoder makes a step q, of a filter with memory p: 1.5 (1 - p)^2 (1
// + p) q/T [rad/s].
inline double velocity_jump(double p, double q, double T) {
  return 1.5 * (1 - p) * (1 - p) * (1 + p) * q / T;
}

// True if some joint that moves alone, the others free, loses its motion to its damping b_d within
// a tick: T b_d_j (M^-1)_jj > 1. From 2 on the midpoint rule predicts oscillation; with little
// memory this grows from 2.7 on (chains of 3 to 30 joints, of many masses).
template <int N>
bool dies_within_a_tick(const Mat<N>& M, const Vec<N>& b_d, double T) {
  const SymmetricFactor<N> factor(M);
  for (Eigen::Index j = 0; j < b_d.size(); ++j) {
    const Vec<N> unit = Vec<N>::Unit(b_d.size(), j);
    if (T * b_d[j] * Vec<N>(factor.solve(unit))[j] > 1) return true;
  }
  return false;
}

// M += mass J^T J, column by column for many joints: a general product would first copy all.
template <int N>
void add_mass(double mass, const Jacobian<N>& J, Mat<N>& M) {
  const Eigen::Matrix<double, N, 3, 0, kCapacity<N>, 3> J_T = J.transpose();
  const double *x = J_T.data(), *y = x + J_T.rows(), *z = y + J_T.rows();
  for (Eigen::Index j = 0; j < M.cols(); ++j) {
    const Vec3 a = mass * J.col(j);
    double* const column = M.data() + j * M.rows();
    for (Eigen::Index i = 0; i < M.rows(); ++i) {
      column[i] += x[i] * a.x() + y[i] * a.y() + z[i] * a.z();
    }
  }
}

// Two predictors side by side, for a light hand and for one with mass; the one whose predictions
// were better lately is active.
template <int N>
class Predictor {
 public:
  // Begins with the device's position and velocity, and the hand's torque [rad, rad/s, N m].
  void start(const Vec<N>& x, const Vec<N>& v, const Vec<N>& f) {
    const Vec<N> zero = Vec<N>::Zero(x.size());
    ahead_ = Vec<N>::Constant(x.size(), kMidpoint);
    tracks_.fill({x, v, zero, f, x, v, 0, zero, zero, {}, x, v});
    rest_rate_ = doubt_ = 0;
    sent_.fill(zero);
    active_ = 0;
  }
  // Takes the first reading: from now on the device is where the encoders say [rad].
  void begin_at(const Vec<N>& y) {
    for (Track& t : tracks_) t.x = t.x_ahead = t.x_met = y;
  }

  // Corrects by a reading y, `elapsed` after the last one [rad, s]. q: the encoders' step [rad]; p:
  // memory of the filter, NaN where it weighs the step; both: the second predictor runs too.
  void correct(const Vec<N>& y, double elapsed, double q, double p, bool both) {
    const double forget = exponential(-elapsed / kJudged);
    const bool weighs = std::isnan(p);
    double doubt = 0;
    for (Track& t : tracks_) {
      t.x_ahead = t.x + elapsed * t.w;  // as predicted
      t.v_ahead = end_velocity(t.v, t.w);
      t.news = y - t.x_ahead;
      if (weighs) {
        doubt += (&t == &tracks_[0] ? 1 : -1) * weigh(t, elapsed, q);
      } else {
        fade(t, elapsed, q, p);
        t.misses = forget * t.misses + t.news.squaredNorm();
      }
      if (!both) break;
    }
    doubt_ = both ? forget * doubt_ + doubt : 0;
    if (!both) {
      active_ = 0;
    } else if (weighs ? other_is_surer() : other_missed_less()) {
      active_ = 1 - active_;
    }
  }

  // Sets how fast the hand's force may change until the next reading. on_tip: response of the
  // device to a force at the tip; J: of the tip; at_rest: the rate at rest [N/s].
  void expect_hand(const Levers<N>& on_tip, const Jacobian<N>& J, double hand_mass,
                   double at_rest) {
    const Mat3 yields = Mat3::Identity() + hand_mass * (J * on_tip), carried = yields.inverse();
    rest_rate_ = at_rest * std::sqrt(on_tip.rowwise().squaredNorm().maxCoeff());
    const double light = at_rest + kHandHold * (J * tracks_[0].v).norm();
    const double heavy = at_rest + kHandHold * (J * tracks_[1].v).norm();
    for (Eigen::Index i = 0; i < on_tip.rows(); ++i) {
      const Vec3 moved = on_tip.row(i).transpose();
      tracks_[0].rate[i] = light * moved.norm();
      tracks_[1].rate[i] = heavy * (carried * moved).norm();
    }
  }
  // Jump of a joint's velocity when an encoder makes a step q, at rest, where the coming torque
  // meets the device [rad/s].
  double weighed_jump(double q) const {
    const double w = std::min(filter_bandwidth(rest_rate_, q), quickest(T_));
    return q * w * (1 + w * delay_ * T_);
  }

  // State of the device now, by the active predictor [rad, rad/s].
  const Vec<N>& x_now() const { return active().x; }
  const Vec<N>& v_now() const { return active().v; }

  // Sets the model of the device at x_now(): M, C, its damping b_d, the tip's J; T of the coming
  // tick [s]. p: as correct() had it. quick: see dies_within_a_tick(). If the coming torque is
  // known to be late, goes on to where it will meet the device.
  void model(const Mat<N>& M, const Mat<N>& C, const Vec<N>& b_d, const Jacobian<N>& J, double T,
             double p, double mu, double hand_mass, int delay, bool quick) {
    T_ = T;
    delay_ = delay;
    if (quick) {
      ahead_ = exact_decay(M, b_d, T);
    } else {
      ahead_.setConstant(M.rows(), kMidpoint);
    }
    const double fresh = 1 - p, gain = std::isnan(p) ? 1 : fresh * fresh * fresh / (T * T);
    for (std::size_t m = 0; m < (hand_mass > 0 ? 2 : 1); ++m) {
      Track& t = tracks_[m];
      t.Mp = mu * M;
      if (m == 1) add_mass(hand_mass, J, t.Mp);
      t.f += gain * (t.Mp * t.news);
      t.Mp = (t.Mp * (ahead_ / T).asDiagonal()).eval();
      t.D0 = t.Mp + C;
      t.D0.diagonal() += b_d;
      if (m == 0) {
        D0_inverse_.compute(widened<N>(t.D0));
      } else {
        carry(hand_mass, J);
      }
      t.x_met = t.x;
      t.v_met = t.v;
      for (int k = 0; k < delay; ++k) {
        const Vec<N> w = mean_velocity(t, t.v_met, under_way(k));
        if (k == 0) t.w = w;
        t.x_met += T * w;
        t.v_met = end_velocity(t.v_met, w);
      }
    }
  }

  // State by the active predictor where the coming torque meets the device. The motion is D0 w =
  // drive() + tau, w the mean velocity over the tick.
  const Vec<N>& x() const { return active().x_met; }
  const Mat<N>& D0() const { return active().D0; }
  Vec<N> drive() const { return active().Mp * active().v_met + active().f; }
  bool heavy_hand() const { return active_ == 1; }

  // Takes the torque that reaches the motors at the coming tick [N m].
  void applied(const Vec<N>& tau, bool both) {
    newest_ = (newest_ + 1) % sent_.size();
    sent_[newest_] = tau;
    if (delay_ > 0) return;
    for (std::size_t m = 0; m < (both ? 2 : 1); ++m) {
      tracks_[m].w = mean_velocity(tracks_[m], tracks_[m].v, tau);
    }
  }
  // Torque that was sent `before` ticks before the last one [N m].
  const Vec<N>& sent(int before) const {
    return sent_[(newest_ + sent_.size() - static_cast<std::size_t>(before)) % sent_.size()];
  }
  // Predicted mean velocity for the tick that begins [rad/s].
  const Vec<N>& w() const { return active().w; }

 private:
  struct Track {
    Vec<N> x, v;              // at the last reading, corrected [rad, rad/s]
    Vec<N> w;                 // predicted mean velocity for the tick after it [rad/s]
    Vec<N> f;                 // torque of the hand and of all that the model lacks [N m]
    Vec<N> x_ahead, v_ahead;  // predicted for the next reading
    double misses = 0;        // squared errors, fading [rad^2]
    Vec<N> news{};            // of the last reading: see fade() and weigh()
    Vec<N> rate{};            // of the acceleration by a hand [rad/s^3]
    std::array<EncoderFilter, kCapacity<N>> filters{};  // of each joint
    Vec<N> x_met{}, v_met{};  // state where the coming torque meets the device
    Mat<N> Mp{}, D0{};        // Mp: inertia over the tick's length [N m s/rad]; D0: Mp + C + b_d
  };
  static constexpr double kJudged = 0.05;  // time constant of judging predictions [s]
  static constexpr double kSurer = 1;      // doubt from which on the other predictor is active

  static constexpr double kMidpoint = 2;  // exact_decay() of the midpoint rule

  // Corrects by the error in `news` with a memory p that fades; inside a cell an encoder says
  // nothing.
  static void fade(Track& t, double T, double q, double p) {
    if (q > 0) t.news -= t.news.cwiseMin(q / 2).cwiseMax(-q / 2);
    t.x = t.x_ahead + (1 - p * p * p) * t.news;
    t.v = t.v_ahead + 1.5 * (1 - p) * (1 - p) * (1 + p) / T * t.news;
  }
  // Corrects by the error in `news`, joint by joint, and leaves there the change of the
  // acceleration [rad/s^2]. Returns the surprise.
  static double weigh(Track& t, double T, double q) {
    double surprise = 0;
    const double most = filter_rate(quickest(T), q);
    for (Eigen::Index i = 0; i < t.news.size(); ++i) {
      const double e = t.news[i];
      const auto gains =
          t.filters[static_cast<std::size_t>(i)].take(T, q, std::min(t.rate[i], most));
      t.x[i] = t.x_ahead[i] + gains.x * e;
      t.v[i] = t.v_ahead[i] + gains.v * e;
      t.news[i] = gains.a * e;
      surprise += gains.surprise(e);
    }
    return surprise;
  }

  bool other_is_surer() const { return active_ == 0 ? doubt_ > kSurer : doubt_ < -kSurer; }
  bool other_missed_less() const {
    return active_ == 0 ? 2 * tracks_[1].misses < tracks_[0].misses
                        : tracks_[0].misses < tracks_[1].misses;
  }

  const Track& active() const { return tracks_[active_]; }
  Vec<N> mean_velocity(const Track& t, const Vec<N>& v, const Vec<N>& tau) const {
    Vec<N> w = D0_inverse_.solve((t.Mp * v + t.f + tau).eval());
    if (&t == &tracks_[1]) w -= of_tip_ * (held_ * (J_ * w));
    return w;
  }
  // Velocity after a tick with the mean velocity w.
  Vec<N> end_velocity(const Vec<N>& v, const Vec<N>& w) const {
    return v + ahead_.cwiseProduct(w - v);
  }
  // Factor of w - v by which the velocity changes over a tick, w the mean, exact for a joint that
  // dies out by itself. With a = T b_d (M^-1)_jj it is 1/theta, theta = (a/(1 - e^-a) - 1)/a; 2 for
  // a -> 0.
  static Vec<N> exact_decay(const Mat<N>& M, const Vec<N>& b_d, double T) {
    constexpr double kSlow = 1e-3;  // below: theta = 1/2 + a/12
    Wide<N> M_inverse = widened<N>(Mat<N>::Identity(M.rows(), M.cols()));
    SymmetricFactor<N>(M).divide(M_inverse);
    Vec<N> ahead = b_d;
    for (Eigen::Index j = 0; j < b_d.size(); ++j) {
      const double a = T * b_d[j] * M_inverse(j, j);
      ahead[j] = 1 / (a > kSlow ? (a / (1 - exponential(-a)) - 1) / a : 0.5 + a / 12);
    }
    return ahead;
  }

  // Prepares the second predictor. Its D0 is the first one's and 1/T m J^T J A, m the hand's mass,
  // A the diagonal of ahead_. The mass takes off a motion: D0^-1 J^T (T/m + J A D0^-1 J^T)^-1 J A.
  void carry(double hand_mass, const Jacobian<N>& J) {
    J_ = J * ahead_.asDiagonal();
    of_tip_ = D0_inverse_.solve(Levers<N>(J.transpose()));
    Mat3 yields = J_ * of_tip_;
    yields.diagonal().array() += T_ / hand_mass;
    held_ = yields.inverse();
  }

  // Torque that will act in `ahead` ticks; the present tick's is not yet sent [N m].
  const Vec<N>& under_way(int ahead) const { return sent(delay_ - 1 - ahead); }

  std::array<Track, 2> tracks_;
  SteadyFactor<N> D0_inverse_;  // of the first predictor
  Jacobian<N> J_;               // of the tip, see carry()
  Levers<N> of_tip_;            // response of the first predictor to a force at the tip
  Mat3 held_;                   // see carry()
  std::size_t active_ = 0;
  double doubt_ = 0;      // surprise of the first predictor less the second one's, fading
  double rest_rate_ = 0;  // largest rate of a joint's acceleration by a hand at rest [rad/s^3]
  Vec<N> ahead_;          // see exact_decay()
  // Torques that were sent, in a ring: the delay may turn out to be another one [N m].
  std::array<Vec<N>, kMostDelay + 1> sent_;
  std::size_t newest_ = 0;
  int delay_ = 0;
  double T_ = 0.001;
};

}  // namespace limpid
