// Estimate of a joint's motion from the readings of an encoder with steps.
//
// Kalman's filter of position, velocity and acceleration. A reading is off by anything within a
// step q, a variance of q^2/12. The hand changes the acceleration at a rate r [rad/s^3]. At rest
// the filter has three poles of one magnitude, its bandwidth
//     w = (sqrt(12) r / q)^(1/3)  [rad/s],   gains 2 w T, 2 w^2 T, w^3 T,
// in which the tick T does not occur: the longer readings repeat themselves, the less each counts.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/elementary.h"

namespace limpid {

// Rate at which a hand's force is expected to change [N/s]: kForceRate at rest, and by kHandHold
// [N/m] times its speed, as of a hand that holds. With 800 N/m the filter of a moving hand would be
// quicker than a transmission that yields allows; rigid ones do not tell 200 from 800.
inline constexpr double kForceRate = 10, kHandHold = 200;

// Variance of a reading [rad^2].
inline double reading_variance(double q) { return q * q / 12; }

// Bandwidth w by a rate r [rad/s]; of joints in [rad/s^3, rad], of a tip in [m/s^3, m].
inline double filter_bandwidth(double r, double q) {
  return r > 0 ? power(r / std::sqrt(reading_variance(q)), 1.0 / 3) : 0;
}
// Rate by which a filter has the bandwidth w.
inline double filter_rate(double w, double q) { return w * w * w * std::sqrt(reading_variance(q)); }

// Largest bandwidth of a filter at a tick T, about that of exact encoders [rad/s]: a quicker one
// would take a reading for news of an acceleration that it does not tell.
inline double quickest(double T) { return 1.2 / T; }

// Rate of the hand's force at rest [N/s]. On a wall of stiffness K it is so large that w >=
// sqrt(K/m_n): a slower filter swings with the wall. q_t: the encoders' step at the tip [m].
inline double resting_rate(double K, double m_n, double q_t) {
  return std::max(kForceRate, K * std::sqrt(K / m_n) * std::sqrt(reading_variance(q_t)));
}

// Uncertainty of one joint's motion, from reading to reading.
class EncoderFilter {
 public:
  // Corrections of position, velocity and acceleration for an error of the prediction of 1 rad.
  struct Gains {
    double x, v, a;
    double variance;  // of the error [rad^2]
    // Log of the likelihood of an error e, without its sign and its constant.
    double surprise(double e) const { return (logarithm(variance) + e * e / variance) / 2; }
  };

  // Takes a reading T after the last one [s]. r: rate of the acceleration since then [rad/s^3].
  Gains take(double T, double q, double r) {
    const double R = reading_variance(q), h = T * T / 2, grown = T * r;
    const double across_v = xv_ + T * vv_ + h * va_;  // of the new x with the old v
    const double xa = xa_ + T * va_ + h * aa_;
    const double xx = xx_ + T * (xv_ + across_v) + h * (xa_ + xa);
    const double xv = across_v + T * xa;
    const double va = va_ + T * aa_;
    const double vv = vv_ + T * (va_ + va);
    const double aa = aa_ + grown * grown;
    const Gains g{xx / (xx + R), xv / (xx + R), xa / (xx + R), xx + R};
    const double left = R / g.variance;
    xx_ = left * xx;
    xv_ = left * xv;
    xa_ = left * xa;
    vv_ = vv - g.v * xv;
    va_ = va - g.v * xa;
    aa_ = aa - g.a * xa;
    return g;
  }

 private:
  // Covariance, before the first reading that of a device whose motion is hardly known.
  double xx_ = 1e-8, xv_ = 0, xa_ = 0, vv_ = 1, va_ = 0, aa_ = 1e4;
};

}  // namespace limpid
