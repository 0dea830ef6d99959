// The virtual device: an arm of continuous-time physics with motors, encoders and a hand on it.
#pragma once

#include <optional>
#include <span>

#include "core/dynamics/arm.h"
#include "core/math/solve.h"
#include "core/tick/parameters.h"
#include "core/tick/tick.h"
#include "devices/device.h"

namespace limpid {

// (5) with viscous damping, Coulomb friction, joint stops, and the hand's spring, damper and mass
// at the tip; gravity counts as compensated and springs as not there, unless p has them. Integrated
// in substeps of the tick with the motor torque held: linearly implicit midpoint rule, second order
// and without numerical damping, stable for every grip. Several substeps share one look at where
// the arm is and how heavy, taken where it is on average over them, x + S v/2 + S dv/6, v + dv/2 if
// v changes by dv in S seconds: what changes evenly then makes no error, and what is left is of
// second order in the arm's way in S.
template <int N>
class VirtualArm {
 public:
  explicit VirtualArm(const ArmDescription& arm);

  // Puts it somewhere, the hand's target on the tip [rad, rad/s].
  void place(const Vec<N>& x, const Vec<N>& v, const Vec3& target);
  // As the encoders and as a god see it.
  Reading<N> read(double encoder_step) const;
  // Lives through one tick under this motor torque [N m].
  void live(const Parameters& p, const Vec<N>& torque, const HandInput& hand);
  Vec3 tip() const { return arm_.tip_at(x_); }
  const Vec<N>& x() const { return x_; }  // [rad]
  const Vec<N>& v() const { return v_; }  // [rad/s]
  // f1, the mean over the tick [N m].
  const Vec<N>& hand_torque() const { return hand_torque_; }

 private:
  // What acts over a tick, and the substep that it is taken in.
  struct Drive {
    double h;                      // [s]
    double stiffness, grip, mass;  // of the hand at the tip [N/m, N s/m, kg]
    Vec3 target, target_rate;      // of the hand, at the tick's start [m, m/s]
    Vec<N> torque;                 // of motors and hand [N m]
    Vec<N> damping, friction;      // of the joints [N m s/rad, N m]
    bool rubs, springy;            // some joint has friction; springs pull
    std::optional<Vec3> gravity;   // of links that weigh something [m/s^2]
  };
  // Where the arm was looked at, and what it was like.
  struct Look {
    Vec<N> x, v;
    typename Arm<N>::Angles angles;
    Mat<N> M;
    Vec<N> Cv;
    Vec3 tip, drift;
    Jacobian<N> J;  // of the tip
  };
  // Substeps under one look, ready to be taken.
  struct Stride {
    Stride(const Drive& d, const Look& look, const Vec<N>& x, const Vec<N>& v);

    const Drive& d;
    const Look& look;
    Mat<N> A;  // A dv = torque at a substep's middle, were v to stay; lower triangle
    SymmetricFactor<N> A_factor;
    Vec<N> torque;              // of motors and hand, less C v [N m]
    double along_rate, answer;  // what the hand makes of the tip's velocity and its change [N s/m]
    Vec3 tip, tip_rate;         // as the look has them [m, m/s]
    Vec3 force = Vec3::Zero();  // of the hand, sum over the substeps [N]
  };

  Drive drive(const Parameters& p, const Vec<N>& torque, const HandInput& hand) const;
  void look(bool drift, const std::optional<Vec3>& gravity);
  void look_ahead(const Drive& d, int s, int share);
  bool resist(const Stride& stride, const Vec<N>& x, const Vec<N>& v, Mat<N>& A, Vec<N>& b) const;
  Vec<N> step(Stride& stride, double t, Vec<N>& x, Vec<N>& v) const;

  Arm<N> arm_;
  Vec<N> damping_, friction_, effort_, lower_, upper_, spring_, offset_;
  Vec3 gravity_;
  Vec<N> x_, v_, hand_torque_;
  Vec3 target_ = Vec3::Zero();
  std::array<Look, 2> looks_;  // the newest two
};

// The virtual arm as a device: a write lives through the tick, its torque acts some ticks later.
template <int N>
class VirtualDevice final : public Device {
 public:
  explicit VirtualDevice(const ArmDescription& arm);

  void expect(const Parameters& p, const HandInput& hand) noexcept override {
    p_ = p;
    hand_ = hand;
  }
  void place(std::span<const double> x, std::span<const double> v,
             const Vec3& target) noexcept override;
  std::optional<DeviceTruth> truth() const noexcept override;
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override;
  void write(std::span<const double> torque) noexcept override;
  void stop() noexcept override { write({}); }

  VirtualArm<N> arm;

 private:
  DeviceTraits traits_;
  Parameters p_;
  HandInput hand_;
  std::array<Vec<N>, kMostDelay + 1> sent_;  // torques, the newest first [N m]
  Vec<N> acted_;                             // the one that the motors gave over the last tick
  std::uint64_t count_ = 0;
};

extern template class VirtualDevice<3>;
extern template class VirtualDevice<7>;
extern template class VirtualDevice<kAnyDof>;
extern template class VirtualArm<3>;
extern template class VirtualArm<7>;
extern template class VirtualArm<kAnyDof>;

}  // namespace limpid
