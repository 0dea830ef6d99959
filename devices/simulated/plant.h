// Imperfections of a device that no law knows of: motors that are slow and give another torque than
// they are told, a transmission that yields, cogging, and encoders that are wrong.
#pragma once

#include "core/tick/parameters.h"
#include "devices/simulated/virtual_arm.h"

namespace limpid {

// Motors, transmission and encoders of the virtual arm, as PlantSettings have them. Per joint:
//
//     i' = w_i (scale tau - i)              current loop, w_i its bandwidth
//     J_m theta'' = i + c(theta) - b_d theta' - f(theta') - s     motor, c its cogging torque
//     s = J_m w^2 (theta - x) + 2 z w J_m (theta' - x')           transmission, on the joint
//
// with z = 0.03, assumed. Encoders, damping b_d and friction f are the motors'. J_m is a part of
// the arm's inertia and taken from its links, so that arm and motors together weigh what the file
// says. With a rigid transmission theta is x. Steps are as short as the arm's substeps or shorter;
// in each, positions go half the way, forces act, and positions go the other half (position
// Verlet).
template <int N>
class Plant {
 public:
  explicit Plant(const ArmDescription& arm);

  // Puts joints and motors at x and v, without torque [rad, rad/s].
  void place(const Vec<N>& x, const Vec<N>& v);
  // Readings of the encoders, not yet rounded to their steps [rad].
  Vec<N> encoders(const Parameters& p, const Vec<N>& x) const;
  // Simulates one tick of the arm in which the motors are told `torque` [N m].
  void live(VirtualArm<N>& arm, const Parameters& p, const Vec<N>& torque, const HandInput& hand);

  // Torque on the joints, mean over the tick [N m]; where the transmission yields, with b_d x', as
  // if the joints had the dampers.
  const Vec<N>& torque() const { return torque_; }
  const Vec<N>& hand_torque() const { return hand_torque_; }  // f1, mean over the tick [N m]

 private:
  Vec<N> current(const Parameters& p, const Vec<N>& wanted, double h);
  Vec<N> transmitted(const VirtualArm<N>& arm, const Parameters& p, const Vec<N>& motors, double h);
  void follow(const VirtualArm<N>& arm) {
    theta_ = arm.x();
    omega_ = arm.v();
  }

  Vec<N> rotors_;              // J_m [kg m^2]
  Vec<N> damping_, friction_;  // of the arm's file [N m s/rad, N m]
  Vec<N> current_;             // i [N m]
  Vec<N> theta_, omega_;       // of the motors [rad, rad/s]
  Vec<N> torque_, hand_torque_;
};

extern template class Plant<3>;
extern template class Plant<7>;
extern template class Plant<kAnyDof>;

}  // namespace limpid
