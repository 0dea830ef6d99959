// Velocity from sampled positions: raw, low-pass, or adaptive window.
#pragma once

#include <array>
#include <cmath>

#include "core/coupling/laws.h"
#include "core/math/sizes.h"

namespace limpid {

// The adaptive window is the end-fit one of Janabi-Sharifi, Hayward and Chen (2000): the longest
// window whose chord passes within one encoder step of every sample in it. Without quantisation
// it is the raw difference.
template <int N>
class VelocityEstimator {
 public:
  explicit VelocityEstimator(Eigen::Index n) { reset(Vec<N>::Zero(n)); }

  // Starts at rest at x.
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
        // First order, implicit: stable at every tick.
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
    double slope = (x - ago(1)[joint]);  // per tick
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

}  // namespace limpid
