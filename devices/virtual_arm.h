// The virtual device: an arm of continuous-time physics with motors, encoders and a hand on it.
#pragma once

#include <span>

#include "core/tick/parameters.h"
#include "core/tick/tick.h"
#include "devices/device.h"
#include "devices/stride.h"

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
  Drive<N> drive(const Parameters& p, const Vec<N>& torque, const HandInput& hand) const;
  void look(bool drift, const std::optional<Vec3>& gravity);
  void look_ahead(const Drive<N>& d, int s, int share, bool within);
  bool within_stops(const Vec<N>& x) const;
  template <class Under>
  Going<N, double> gone(const Drive<N>& d, const Under& stride, const Going<N, double>& from,
                        double t, int substeps, bool& within) const;
  template <class Under>
  void go_resisted(const Drive<N>& d, const Under& stride, double t, Going<N, double>& at) const;

  Arm<N> arm_;
  Vec<N> damping_, friction_, effort_, lower_, upper_, spring_, offset_;
  Vec3 gravity_;
  Vec<N> x_, v_, hand_torque_;
  Vec3 target_ = Vec3::Zero();
  Look<N, Pair> looks_;       // the newest two
  Eigen::Index renewed_ = 0;  // joint whose sine was asked for last
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
  std::array<Vec<N>, kMostDelay + 1> sent_;  // torques, one place a tick in turn [N m]
  std::size_t newest_ = 0;                   // of them
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
