// A controller and a virtual arm whose hand circles slowly with the tip pressed against a plane.
#pragma once

#include <cmath>
#include <vector>

#include "core/tick/tick.h"
#include "devices/simulated/virtual_arm.h"
#include "tests/bench/bench_arm.h"

namespace limpid::bench {

template <int N>
class Pressed {
 public:
  Pressed(const ArmDescription& arm, CouplingKind law) : Pressed(arm, law, bent(arm)) {}
  // Starts in posture x [rad, m].
  Pressed(const ArmDescription& arm, CouplingKind law, const Eigen::VectorXd& x)
      : tip_(tip_of(arm, x)),
        tick_(arm, plane_over(tip_)),
        arm_(arm),
        row_(static_cast<std::size_t>(tick_.layout().stride())) {
    p_.kind = law;
    tick_.start(p_, Start<N>::at_rest(x));
    arm_.place(x, Vec<N>::Zero(x.size()), tip_);
  }

  // Runs a tick of the controller; returns the device's torque [N m, N].
  const Vec<N>& control() {
    const Reading<N> reading{arm_.x(), arm_.x(), arm_.v()};
    return tick_.run(p_, reading, ForceRequest::as_it_is, row_);
  }
  // Runs a tick of the device and the hand.
  void live(const Vec<N>& torque) {
    const double angle = 1e-3 * k_++;
    arm_.live(p_, torque, {tip_ + 0.01 * Vec3(std::cos(angle) - 1, std::sin(angle), -0.1), 1});
  }
  bool touches() const { return !tick_.proxy().f().isZero(0); }
  bool diverged() const { return tick_.diverged(); }

 private:
  Parameters p_;
  Vec3 tip_;
  Tick<N> tick_;
  VirtualArm<N> arm_;
  std::vector<double> row_;
  int k_ = 0;
};

}  // namespace limpid::bench
