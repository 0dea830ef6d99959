// Passive networks that make the hand feel less or more inertia than there is. For eta < 1 each
// joint has a ladder of two springs, a mass and dampers; for eta > 1 a mass on a spring and damper.
#pragma once

#include <complex>
#include <numbers>

#include "core/math/solve.h"

namespace limpid {

// Constants of the ladder of order 3 and of the added mass. The ladder's mass-like share is 1 - eta
// to 1.5 % up to the band's edge, found by optimisation; the proof needs r1.
struct InertiaShape {
  static constexpr double kA1 = 1.0081, kA2 = 1.4799, kA3 = 0.344, kR = 1.3198, kR1 = 0.05;
  static constexpr double kZeta = 0.7;                           // damping ratio of the added mass
  static constexpr double kFastest = 2 * std::numbers::pi * 25;  // its largest edge [rad/s]
  static constexpr double kSlowest = 2 * std::numbers::pi * 2;
  static constexpr double kOnProxy = 0.5;  // most mass added to a proxy, as a part of M1

  // Returns the largest eta beside a proxy of `ratio` = M2 / M1.
  static constexpr double most_eta(double ratio) { return 1 + kOnProxy / ratio; }
};

// Mass added to the inertia for eta above 1, and the edge up to which it moves along.
struct AddedMass {
  double eta;   // the requested one, or as much as delay and proxy allow
  double edge;  // w_g of its spring; eta is felt up to about this [rad/s]
};

// Returns the mass that is stable in ticks of T. Above w_g the added mass is a damper of beta = 2
// zeta (eta - 1) w_g for every kg m^2. A torque that is late by t turns a damper into a spring that
// pushes on at pi/2. With the tick's own t = T/2 and more the device would swing at w_1 = pi/(2 t)
// from beta = w_1 on. So beta t stays below the values found stable with grips of up to 3000 N/m:
// 0.9 of the tick itself, 0.35 of a delay. If the edge would fall below kSlowest, eta is reduced
// instead. late: largest delay beyond the tick [ticks].
//
// The law adds mass to device and proxy alike, by the device's velocity alone. A proxy of `ratio` =
// M2 / M1 to which much of M1 is added swings against the device. So (eta - 1) ratio stays below
// kOnProxy: no swinging was found up to 0.5, and some from 0.75 on.
AddedMass added_mass(double eta, int late, double T, double ratio);

// Impedance that a network adds to an inertia of 1 kg m^2, without ticks: torque over velocity at w
// [rad/s]. `band`: the ladder's edge, below eta 1 [Hz].
std::complex<double> network_impedance(const AddedMass& added, double band, double w);

// A network for each joint, driven by the device's motion through R_N, M-like: N = R_N R_N^T. All
// time dependence of eta and of the inertia is in R_N. So for every eta(t) the work given over a
// tick is at most the storage lost and b_e |dx1|^2/T. b_e is a few percent of the device's damping.
template <int N>
class InertiaNetwork : InertiaShape {
 public:
  void start(Eigen::Index n) {
    s_ = v_ = g_ = Vec<N>::Zero(n);
    R_ = Mat<N>::Zero(n, n);
    side_ = 0;
  }

  // Advances over the tick of T [s] just ended, in which the device moved by dx [rad].
  void advance(const Vec<N>& dx, double T) {
    if (side_ == 0) return;
    const Vec<N> nu = R_.transpose() * dx / T;
    if (side_ < 0) {
      climb(nu, T * w2_);
    } else {
      const double h = T * w2_;
      const Vec<N> d = (nu - g_ - h / 2 * s_) / (1 + kZeta * h + h * h / 4);
      s_ += h * d;
      g_ = 2 * (nu - d) - g_;
    }
  }

  // Sets eta and the locked inertia M_L for the tick that begins. `gain`: share of the added
  // inertia; `band`: edge of the band in which eta below 1 holds [Hz].
  void set(const AddedMass& added, const Mat<N>& M_L, double gain, double T, double band) {
    const double eta = added.eta;
    const int side = eta < 1 ? -1 : eta > 1 ? 1 : 0;
    if (side != side_) start(M_L.rows());  // stored energy is lost, never gained
    side_ = side;
    w2_ = side > 0 ? added.edge : 2 * std::numbers::pi * band;
    const Eigen::Index n = M_L.rows();
    if (side == 0) {
      force_ = Vec<N>::Zero(n);
      K_ = R_ = Mat<N>::Zero(n, n);
      return;
    }
    const double scale = side < 0 ? (1 - eta) / (1 + (kR + kR1) * w2_ * T / 2) : gain * (eta - 1);
    R_ = std::sqrt(scale) * cholesky<N>(M_L);
    if (side < 0) {
      force_ = -w2_ * (R_ * s_);
      K_ = Mat<N>::Zero(n, n);
    } else {
      const double h = T * w2_;
      const double gamma = w2_ * (h / 2 + 2 * kZeta) / (1 + kZeta * h + h * h / 4);
      force_ = -R_ * (w2_ * s_ - gamma * (g_ + h / 2 * s_));
      K_ = gamma * (R_ * R_.transpose());
    }
  }

  // Damps by the device's present velocity v [rad/s] instead of the coming tick's.
  void damp_now(const Vec<N>& v) {
    force_ -= K_ * v;
    K_.setZero();
  }

  // Removes `energy` [J] from the storage: a motor at its limit kept the network from taking it.
  // The added mass keeps its speed; changing it would push.
  void lose(double energy) {
    const double stored = side_ > 0 ? 0.5 * s_.squaredNorm() : storage();
    if (!(energy > 0) || !(stored > 0)) return;
    const double left = std::sqrt(std::max(0.0, 1 - energy / stored));
    s_ *= left;
    if (side_ > 0) return;
    v_ *= left;
    g_ *= left;
  }

  // The network's torque on the device over the tick, force() - damping() w [N m, N m s/rad].
  const Vec<N>& force() const { return force_; }
  const Mat<N>& damping() const { return K_; }
  bool damps() const { return side_ > 0; }
  double storage() const {  // S [J]
    if (side_ == 0) return 0;
    if (side_ > 0) return 0.5 * (s_.squaredNorm() + g_.squaredNorm());
    return 0.5 * (kA1 * s_.squaredNorm() + kA2 * v_.squaredNorm() + kA3 * g_.squaredNorm());
  }

 private:
  // Midpoint rule of q' = w2 (A q + (nu / a1, 0, 0)), q = (s, v, g) of each joint; step = T w2.
  void climb(const Vec<N>& nu, double step) {
    if (step != step_) {
      Mat3 A;
      A << 0, -1 / kA1, 0, 1 / kA2, -kR1 / kA2, -1 / kA2, 0, 1 / kA3, -1 / (kA3 * kR);
      middle_ = (Mat3::Identity() - step / 2 * A).inverse();
      step_ = step;
    }
    for (Eigen::Index i = 0; i < nu.size(); ++i) {
      const Vec3 q(s_[i], v_[i], g_[i]);
      const Vec3 next = 2 * (middle_ * (q + Vec3(step / (2 * kA1) * nu[i], 0, 0))) - q;
      s_[i] = next.x();
      v_[i] = next.y();
      g_[i] = next.z();
    }
  }

  Vec<N> s_, v_, g_;
  Mat<N> R_;
  int side_ = 0;   // -1 ladder, +1 added mass, 0 neither
  double w2_ = 0;  // edge of the band or of the added mass, in the tick of R_ [rad/s]
  double step_ = 0;
  Mat3 middle_;
  Vec<N> force_;
  Mat<N> K_;
};

}  // namespace limpid
