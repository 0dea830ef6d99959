// The human force observer, (16)-(18).
#pragma once

#include "core/math/sizes.h"
#include "core/math/solve.h"

namespace limpid {

// With f1_hat = z + alpha v, (17) says f1_hat' = L (f1 - f1_hat), L = alpha M^-1: the disturbance
//     d = M vdot + C v - tau
// seen through a first-order filter. Over one tick this is
//     f1_hat_k = E f1_hat_k-1 + (1 - E) d_k,   E = (1 + A + A^2/2)^-1 ~ exp(-A),   A = T alpha
//     M^-1,
// second-order accurate, and with 0 < E < 1 stable for every alpha and T.
//
// The velocity difference of two sampled velocities averages the accelerations of the last two
// ticks, so the torque beside it is the mean of the last two.
template <int N>
class ForceObserver {
 public:
  explicit ForceObserver(Eigen::Index n) { reset(Vec<N>::Zero(n), Vec<N>::Zero(n)); }

  // Starts with this estimate [N m] at this velocity [rad/s], no torque before.
  void reset(const Vec<N>& estimate, const Vec<N>& v) {
    f1_hat_ = estimate;
    v_ = v;
    tau_ = tau_before_ = Vec<N>::Zero(v.size());
  }

  // The estimate at t_k [N m]. M, C the device model at t_k; v the measured velocity; b_d the
  // device's own damping, which the motors do not command and which is no human force.
  const Vec<N>& estimate(double alpha, double T, const Mat<N>& M, const Mat<N>& C, const Vec<N>& v,
                         const Vec<N>& b_d) {
    const Vec<N> tau = 0.5 * (tau_ + tau_before_ - b_d.cwiseProduct(v + v_));
    const Vec<N> error = M * (v - v_) / T + C * v - tau - f1_hat_;  // d - f1_hat
    // f1_hat += (1 - E) error, with M (1 - E) = (A M + A^2 M / 2) E and so
    // (M + a + a^2 M^-1 / 2) (1 - E) = a + a^2 M^-1 / 2, a = T alpha.
    const double a = T * alpha;
    const Eigen::Index n = v.size();
    const Mat<N> a_identity = a * Mat<N>::Identity(n, n);
    const Mat<N> gain = a_identity + 0.5 * a * solve_symmetric<N>(M, a_identity);
    const Mat<N> whole = M + gain;
    const Vec<N> drive = gain * error;
    f1_hat_ += solve_symmetric<N>(whole, drive);
    v_ = v;
    return f1_hat_;
  }

  const Vec<N>& present() const { return f1_hat_; }

  // The motor torque held over the tick that begins now [N m].
  void applied(const Vec<N>& tau) {
    tau_before_ = tau_;
    tau_ = tau;
  }

 private:
  Vec<N> f1_hat_, v_;
  Vec<N> tau_, tau_before_;
};

}  // namespace limpid
