// The human force observer, (16)-(18), and the velocity estimate for it.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "core/coupling/observer_settings.h"
#include "core/math/sizes.h"
#include "core/math/solve.h"

namespace limpid {

// Velocity from sampled positions: raw, low-pass, or adaptive window. The adaptive window is the
// end-fit one of Janabi-Sharifi, Hayward and Chen (2000): the longest window whose chord passes
// within one encoder step of every sample in it. Without quantisation it is the raw difference.
template <int N>
class VelocityEstimator {
 public:
  explicit VelocityEstimator(Eigen::Index n) { reset(Vec<N>::Zero(n)); }

  // Begins at rest at x.
  void reset(const Vec<N>& x) {
    past_.fill(x);
    newest_ = 0;
    known_ = 1;
    raw_ = estimate_ = Vec<N>::Zero(x.size());
  }

  void update(const Vec<N>& x, double T, VelocitySource source, double encoder_step) {
    raw_ = (x - past_[newest_]) / T;
    newest_ = (newest_ + 1) % kWindow;
    past_[newest_] = x;
    known_ = std::min(known_ + 1, kWindow);
    switch (source) {
      case VelocitySource::raw: estimate_ = raw_; break;
      case VelocitySource::lowpass: {
        // A first-order filter, implicit: stable at every tick.
        const double gain = T * kCutoff / (1 + T * kCutoff);
        estimate_ += gain * (raw_ - estimate_);
        break;
      }
      case VelocitySource::adaptive:
        for (Eigen::Index i = 0; i < x.size(); ++i) estimate_[i] = end_fit(i, T, encoder_step);
        break;
    }
  }

  const Vec<N>& raw() const { return raw_; }            // (x_k - x_k-1) / T [rad/s]
  const Vec<N>& estimate() const { return estimate_; }  // [rad/s]

 private:
  static constexpr std::size_t kWindow = 17;
  static constexpr double kCutoff = 2 * 3.14159265358979323846 * 50;  // [rad/s]

  const Vec<N>& ago(std::size_t ticks) const {
    return past_[(newest_ + kWindow - ticks) % kWindow];
  }

  double end_fit(Eigen::Index joint, double T, double step) const {
    const double x = ago(0)[joint];
    double slope = (x - ago(1)[joint]);  // [rad] a tick
    for (std::size_t length = 2; length < known_; ++length) {
      const double chord = (x - ago(length)[joint]) / static_cast<double>(length);
      for (std::size_t i = 1; i < length; ++i) {
        const double miss = ago(i)[joint] - (x - chord * static_cast<double>(i));
        if (std::abs(miss) > step * (1 + 1e-9)) return slope / T;
      }
      slope = chord;
    }
    return slope / T;
  }

  std::array<Vec<N>, kWindow> past_;
  std::size_t newest_ = 0;
  std::size_t known_ = 1;
  Vec<N> raw_, estimate_;
};

// Observer of the human force. With f1_hat = z + alpha v, (17) says f1_hat' = L (f1 - f1_hat), L =
// alpha M^-1: the disturbance
//     d = M vdot + C v - tau
// seen through a first-order filter. Over one tick this is
//     f1_hat_k = E f1_hat_k-1 + (1 - E) d_k,   A = T alpha M^-1,
//     E = (1 + (2g - 1) A) (1 + g A)^-2 ~ exp(-A),   g = 1 - 1/sqrt(2),
// second-order accurate, and with -0.21 < E < 1 stable for every alpha and T; one factorisation is
// enough for both powers.
//
// The difference of two sampled velocities averages the accelerations of the last two ticks. So the
// torque beside it is the mean of the last two.
template <int N>
class ForceObserver {
 public:
  explicit ForceObserver(Eigen::Index n) { reset(Vec<N>::Zero(n), Vec<N>::Zero(n)); }

  // Begins with an estimate [N m] at a velocity [rad/s], with no earlier torque.
  void reset(const Vec<N>& estimate, const Vec<N>& v) {
    f1_hat_ = estimate;
    v_ = v;
    tau_ = tau_before_ = Vec<N>::Zero(v.size());
  }

  // Returns the estimate at t_k [N m]. M, C: device model at t_k; v: measured velocity; b_d: the
  // device's own damping, which the motors do not command and which is no human force.
  const Vec<N>& estimate(double alpha, double T, const Mat<N>& M, const Mat<N>& C, const Vec<N>& v,
                         const Vec<N>& b_d) {
    const Vec<N> tau = 0.5 * (tau_ + tau_before_ - b_d.cwiseProduct(v + v_));
    Vec<N> error = -tau - f1_hat_;  // d - f1_hat
    error.noalias() += M * ((v - v_) / T);
    error.noalias() += C * v;
    // f1_hat += (1 - E) error: in fractions, with a = T alpha, P = M + g a,
    //     1 - E = a P^-1 - g (1 - g) (a P^-1)^2.
    const double a = T * alpha;
    Mat<N> P = M;
    P.diagonal().array() += kPole * a;
    const SymmetricFactor<N> factor(P);
    const Vec<N> once = a * factor.solve(error);
    f1_hat_ += once - kPole * (1 - kPole) * a * factor.solve(once);
    v_ = v;
    return f1_hat_;
  }

  const Vec<N>& present() const { return f1_hat_; }

  // Takes the motor torque held over the tick that begins now [N m].
  void applied(const Vec<N>& tau) {
    tau_before_ = tau_;
    tau_ = tau;
  }

 private:
  static constexpr double kPole = 1 - 1 / std::numbers::sqrt2;  // g

  Vec<N> f1_hat_, v_;
  Vec<N> tau_, tau_before_;
};

}  // namespace limpid
