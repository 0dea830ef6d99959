// The virtual arm: continuous-time physics of an arm with a hand on it.
#pragma once

#include <optional>
#include <span>

#include "core/dynamics/arm.h"
#include "core/math/solve.h"
#include "core/tick/parameters.h"
#include "devices/device.h"

namespace limpid {

// Model of the arm at the place x, v of its linearization. S: double, or Pair for two places.
template <int N, class S>
struct Linearization {
  VecOf<N, S> x, v;
  typename Arm<N>::template AnglesOf<S> angles;
  MatOf<N, S> M;
  VecOf<N, S> Cv;
  Vec3Of<S> tip, drift;  // drift: Jdot v
  JacobianOf<N, S> J;    // of the tip
};

// Model `which` of two, as far as substeps use it.
template <int N>
Linearization<N, double> one(const Linearization<N, Pair>& two, int which) {
  Linearization<N, double> at;
  take(two.x, which, at.x);
  take(two.M, which, at.M);
  take(two.Cv, which, at.Cv);
  take(two.tip, which, at.tip);
  take(two.drift, which, at.drift);
  take(two.J, which, at.J);
  return at;
}

// The second of two models, extrapolated: beyond it by `on` times its difference from the first.
template <class Both, class One>
void take_beyond(const Both& both, double on, One& one) {
  one.resize(both.rows(), both.cols());
  for (Eigen::Index i = 0; i < both.size(); ++i) {
    const Pair& pair = both.data()[i];
    one.data()[i] = pair[1] + on * (pair[1] - pair[0]);
  }
}
template <int N>
Linearization<N, double> beyond(const Linearization<N, Pair>& two, double on) {
  Linearization<N, double> at;
  take(two.x, 1, at.x);
  take(two.angles.sin, 1, at.angles.sin);
  take(two.angles.cos, 1, at.angles.cos);
  take(two.tip, 1, at.tip);
  take(two.drift, 1, at.drift);
  take_beyond(two.M, on, at.M);
  take_beyond(two.Cv, on, at.Cv);
  take_beyond(two.J, on, at.J);
  return at;
}

// Everything that acts on the arm over a tick, and the tick's substep.
template <int N>
struct Drive {
  double h;                      // length of a substep [s]
  double stiffness, grip, mass;  // of the hand at the tip [N/m, N s/m, kg]
  Vec3 target, target_rate;      // of the hand, at the tick's start [m, m/s]
  Vec<N> torque;                 // of motors and hand [N m]
  Vec<N> damping, friction;      // of the joints [N m s/rad, N m]
  bool rubs, springy;            // some joint has friction; springs pull
  std::optional<Vec3> gravity;   // set if links weigh something [m/s^2]

  // Hand's force per velocity of the tip, and per change of it, over a substep of dt [N s/m].
  double along_rate(double dt) const { return grip + dt / 2 * stiffness; }
  double answer(double dt) const { return grip / 2 + dt / 4 * stiffness + mass / dt; }
  // Hand's force at t on an arm that stays where it was linearized [N].
  template <class S>
  Vec3Of<S> force_there(const Linearization<N, S>& at, const S& t) const {
    const Vec3 at_start = stiffness * target + grip * target_rate, rate = stiffness * target_rate;
    return at_start.cast<S>() + t * rate.cast<S>() - S(stiffness) * at.tip - S(mass) * at.drift;
  }
};

// State that substeps have reached under a linearization.
template <int N, class S>
struct SubstepState {
  VecOf<N, S> u, v;   // x minus the linearization's x; v
  VecOf<N, S> sum_u;  // sum of u at the start of each substep taken

  void take(double h, const VecOf<N, S>& dv) {
    sum_u += u;
    u += h * (v + 0.5 * dv);
    v += dv;
  }
};

// The hand's force at the tip, summed over the `substeps` from `from` to `to` [N].
template <int N, class S>
Vec3Of<S> hand_force(const Drive<N>& d, const Linearization<N, S>& at, const S& t,
                     const S& substeps, const SubstepState<N, S>& from,
                     const SubstepState<N, S>& to) {
  const VecOf<N, S> dv = to.v - from.v;
  const VecOf<N, S> sum_v = S(1 / d.h) * (to.u - from.u) - S(0.5) * dv;
  const VecOf<N, S> moved =
      S(d.stiffness) * to.sum_u + S(d.along_rate(d.h)) * sum_v + S(d.answer(d.h)) * dv;
  return substeps * d.force_there(at, t + S(0.5 * d.h) * substeps) - at.J * moved;
}

// Arguments of substeps for more than three joints: n, and pointers to columns padded to whole
// fours. `lower`, `corners`: factors of A, see SymmetricFactor.
struct WideSubsteps {
  Eigen::Index n;
  const double *lower, *corners;
  const double *J_T, *steady, *damping;  // 3 columns; constant torque [N m]; of the joints
  double h, stiffness, along_rate;       // as in Drive
  Vec3 force, force_step;  // of the hand where the arm was linearized; its change a substep [N]
  double *u, *v, *sum_u, *dv;
  int count;
};
template <int N>
void run_substeps(const WideSubsteps& steps);
// Sets A to `by` A + `answer` J^T J.
template <int N>
void stiffen(Eigen::Index n, double by, double answer, const double* J_T, double* A);

// Linearly implicit midpoint rule under one linearization. b takes position and velocity at a
// substep's middle t as if v did not change; A corrects for its change dv:
//     A dv = b(t, u, v), x_mid = x + h/2 v + h/4 dv, v_mid = v + dv/2.
template <int N>
class LinearSubsteps {
 public:
  // Keeps references to `drive` and `at`; they must outlive it.
  LinearSubsteps(const Drive<N>& drive, double h, const Linearization<N, double>& at)
      : d_(drive), h_(h), linear_(at), A_(widened<N>(at.M)) {
    if constexpr (N == 3) {
      A_ *= 1 / h;
      for (Eigen::Index j = 0; j < A_.cols(); ++j) {
        const Vec3 held = d_.answer(h) * linear_.J.col(j);
        for (Eigen::Index i = j; i < A_.rows(); ++i) A_(i, j) += linear_.J.col(i).dot(held);
        A_(j, j) += d_.damping[j] / 2;
      }
    } else {
      const Eigen::Index n = A_.cols();
      J_T_.resize(A_.rows(), Eigen::NoChange);
      J_T_.topRows(n) = linear_.J.transpose();
      J_T_.bottomRows(A_.rows() - n).setZero();
      stiffen<N>(n, 1 / h, d_.answer(h), J_T_.data(), A_.data());
      A_.diagonal() += 0.5 * d_.damping;
    }
    factor_.compute_wide(A_);
  }

  double h() const { return h_; }
  const Vec<N>& x() const { return linear_.x; }  // the linearization's
  double M(Eigen::Index joint) const { return linear_.M(joint, joint); }
  Mat<N> A() const { return narrowed<N>(A_); }  // lower triangle
  [[gnu::always_inline]] Vec<N> b(double t, const Vec<N>& u, const Vec<N>& v) const {
    const Vec3 force =
        d_.force_there(linear_, t) - linear_.J * (d_.stiffness * u + d_.along_rate(h_) * v);
    Vec<N> b = d_.torque - linear_.Cv - d_.damping.cwiseProduct(v);
    b.noalias() += linear_.J.transpose() * force;
    return b;
  }

  // Returns the state after so many substeps from `at`, which is at time t.
  SubstepState<N, double> state_after(SubstepState<N, double> at, double t, int substeps) const {
    if constexpr (N == 3) {
      for (int s = 0; s < substeps; ++s) {
        at.take(h_, factor_.solve(b(t + (s + 0.5) * h_, at.u, at.v)));
      }
      return at;
    } else {
      const Eigen::Index n = at.u.size(), p = whole_fours(static_cast<int>(n));
      const WideVec<N> steady = widened_vector<N>(d_.torque - linear_.Cv);
      const WideVec<N> damping = widened_vector<N>(d_.damping);
      WideVec<N> u = widened_vector<N>(at.u), v = widened_vector<N>(at.v);
      WideVec<N> sum_u = widened_vector<N>(at.sum_u), dv(p);
      run_substeps<N>({n, factor_.lower(), factor_.corners(), J_T_.data(), steady.data(),
                       damping.data(), h_, d_.stiffness, d_.along_rate(h_),
                       d_.force_there(linear_, t + 0.5 * h_), h_ * d_.stiffness * d_.target_rate,
                       u.data(), v.data(), sum_u.data(), dv.data(), substeps});
      return {u.head(n), v.head(n), sum_u.head(n)};
    }
  }

 private:
  const Drive<N>& d_;
  double h_;
  const Linearization<N, double>& linear_;
  Wide<N> A_;
  Eigen::Matrix<double, kWideRows<N>, 3, 0, kMostWideRows<N>, 3> J_T_;
  SymmetricFactor<N> factor_;
};

// Substeps under each of two linearizations.
template <int N>
class LinearSubstepsOfTwo {
 public:
  LinearSubstepsOfTwo(const Drive<N>& drive, const Linearization<N, Pair>& two)
      : linear_{one(two, 0), one(two, 1)},
        both_of_them_{LinearSubsteps<N>(drive, drive.h, linear_[0]),
                      LinearSubsteps<N>(drive, drive.h, linear_[1])} {}
  LinearSubstepsOfTwo(const LinearSubstepsOfTwo&) = delete;
  LinearSubstepsOfTwo& operator=(const LinearSubstepsOfTwo&) = delete;
  const LinearSubsteps<N>& operator[](int which) const {
    return both_of_them_[static_cast<std::size_t>(which)];
  }

 private:
  std::array<Linearization<N, double>, 2> linear_;
  std::array<LinearSubsteps<N>, 2> both_of_them_;
};

// For three joints the two linearizations are prepared side by side: dv = P u + Q v + r + t s.
template <>
class LinearSubstepsOfTwo<3> {
 public:
  LinearSubstepsOfTwo(const Drive<3>& drive, const Linearization<3, Pair>& two)
      : d_(drive), linear_(two) {
    Mat3Of<Pair> G;
    for (Eigen::Index j = 0; j < 3; ++j) {
      for (Eigen::Index i = j; i < 3; ++i) {
        G(i, j) = G(j, i) = two.J.col(i).dot(two.J.col(j));
        A_(i, j) = Pair(1 / d_.h) * two.M(i, j) + Pair(d_.answer(d_.h)) * G(i, j);
      }
      A_(j, j) += d_.damping[j] / 2;
    }
    const Mat3Of<Pair> inverse = inverse_symmetric(A_);
    const Mat3Of<Pair> of_grip = inverse * G;
    P_ = Pair(-d_.stiffness) * of_grip;
    Q_ = Pair(-d_.along_rate(d_.h)) * of_grip - inverse * d_.damping.cast<Pair>().asDiagonal();
    r_ = inverse *
         (d_.torque.cast<Pair>() - two.Cv + two.J.transpose() * d_.force_there(two, Pair(0)));
    const Vec3 rate = d_.stiffness * d_.target_rate;
    s_ = inverse * (two.J.transpose() * rate.cast<Pair>());
  }

  // Substeps under one of the two linearizations.
  class Under {
   public:
    Under(const LinearSubstepsOfTwo& both, int which) : both_(both), which_(which) {
      take(both.linear_.x, which, x_);
      for (Eigen::Index j = 0; j < 3; ++j) {
        P_.col(j) = packed(both.P_.col(j), which);
        Q_.col(j) = packed(both.Q_.col(j), which);
      }
      r_ = packed(both.r_, which);
      s_ = packed(both.s_, which);
    }
    double h() const { return both_.d_.h; }
    const Vec3& x() const { return x_; }
    double M(Eigen::Index joint) const { return both_.linear_.M(joint, joint)[which_]; }
    Mat3 A() const {
      Mat3 A;
      take(both_.A_, which_, A);
      return A;
    }
    Vec3 b(double t, const Vec3& u, const Vec3& v) const {
      const Column dv = product(P_, packed(u)) + product(Q_, packed(v)) + r_ + Pair(t) * s_;
      return A().selfadjointView<Eigen::Lower>() * single(dv);
    }
    SubstepState<3, double> state_after(const SubstepState<3, double>& at, double t,
                                        int substeps) const {
      const double h = both_.d_.h;
      Column u = packed(at.u), v = packed(at.v), sum_u = packed(at.sum_u);
      Column now = r_ + Pair(t + h / 2) * s_;
      const Column step = Pair(h) * s_;
      for (int s = 0; s < substeps; ++s) {
        const Column dv = product(P_, u) + product(Q_, v) + now;
        now += step;
        sum_u += u;
        u += Pair(h) * (v + Pair(0.5) * dv);
        v += dv;
      }
      return {single(u), single(v), single(sum_u)};
    }

   private:
    // Three numbers and a 0, two beside each other in a register.
    using Column = Eigen::Matrix<Pair, 2, 1>;
    using Columns = Eigen::Matrix<Pair, 2, 3>;
    template <class V>
    static Column packed(const V& v, int which = 0) {
      return {Pair(of(v[0], which), of(v[1], which)), Pair(of(v[2], which), 0)};
    }
    static Vec3 single(const Column& c) { return {c[0][0], c[0][1], c[1][0]}; }
    static Column product(const Columns& M, const Column& c) {
      return M.col(0) * Pair(c[0][0]) + M.col(1) * Pair(c[0][1]) + M.col(2) * Pair(c[1][0]);
    }

    const LinearSubstepsOfTwo& both_;
    int which_;
    Vec3 x_;
    Columns P_, Q_;
    Column r_, s_;
  };
  Under operator[](int which) const { return {*this, which}; }

 private:
  const Drive<3>& d_;
  const Linearization<3, Pair>& linear_;
  Mat3Of<Pair> A_, P_, Q_;  // of A the lower triangle
  Vec3Of<Pair> r_, s_;
};

// Equation (5) with viscous damping, Coulomb friction, joint stops, and the hand's spring, damper
// and mass at the tip. Gravity counts as compensated and springs as absent, unless p has them.
// Integrates in substeps of the tick, the motor torque held, by the linearly implicit midpoint
// rule: second order, without numerical damping, stable for every grip. Several substeps share one
// linearization, taken at the arm's mean over their S seconds: x + S v/2 + S dv/6 and v + dv/2 for
// a change dv of v. Even changes make no error; the rest is of second order in the arm's way in S.
template <int N>
class VirtualArm {
 public:
  explicit VirtualArm(const ArmDescription& arm);

  // Puts the arm at x and v, the hand's target on the tip [rad, rad/s].
  void place(const Vec<N>& x, const Vec<N>& v, const Vec3& target);
  // Leaves inertias of the joints to whoever simulates them, from the next tick on [kg m^2].
  // Precondition: what is left of M is positive definite.
  void leave_out(const Vec<N>& inertias) { left_out_ = inertias; }
  // Simulates one tick under this motor torque [N m].
  void live(const Parameters& p, const Vec<N>& torque, const HandInput& hand);
  Vec3 tip() const { return arm_.tip_at(x_); }
  const Vec<N>& x() const { return x_; }  // [rad]
  const Vec<N>& v() const { return v_; }  // [rad/s]
  // Place where the hand wants the tip, at the end of the last tick [m].
  const Vec3& target() const { return target_; }
  // f1, the mean over the tick [N m].
  const Vec<N>& hand_torque() const { return hand_torque_; }

 private:
  Drive<N> drive(const Parameters& p, const Vec<N>& torque, const HandInput& hand) const;
  void linearize(bool drift, const std::optional<Vec3>& gravity);
  void linearize_ahead(const Drive<N>& d, int s, int share, bool within);
  bool within_stops(const Vec<N>& x) const;
  template <class Under>
  SubstepState<N, double> state_after(const Drive<N>& d, const Under& model,
                                      const SubstepState<N, double>& from, double t, int substeps,
                                      bool& within) const;
  template <class Under>
  void resisted_substep(const Drive<N>& d, const Under& model, double t,
                        SubstepState<N, double>& at) const;

  Arm<N> arm_;
  Vec<N> damping_, friction_, effort_, lower_, upper_, spring_, offset_, left_out_;
  Vec3 gravity_;
  Vec<N> x_, v_, hand_torque_;
  Vec3 target_ = Vec3::Zero();
  Linearization<N, Pair> linear_;  // the newest two
  Eigen::Index renewed_ = 0;       // joint whose sine and cosine were renewed last
};

extern template class VirtualArm<3>;
extern template class VirtualArm<7>;
extern template class VirtualArm<kAnyDof>;

}  // namespace limpid
