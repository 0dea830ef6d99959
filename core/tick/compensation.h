// Compensation of the device's own forces by the motors: weight, springs, and part of the friction.
//
// Weight and springs have a potential: energy that the motors give on the way up returns on the way
// down. Of the friction f_c they give the torque s f_c sigma(v), |sigma| <= 1, s < 1. This puts out
// at most s f_c |v| for any v, late or noisy, while the device itself takes f_c |v|. So motors and
// friction together stay passive as long as s times the friction believed is at most the true one.
// Near rest sigma is smooth; v is filtered and sigma wide enough for the encoder's steps, so that
// it does not chatter at rest.
#pragma once

#include "core/dynamics/arm.h"
#include "core/tick/parameters.h"

namespace limpid {

// Gravity in the base's frame [m/s^2]; of_arm: as the arm's file has it.
Vec3 gravity_of(Down down, const Vec3& of_arm);

template <int N>
class Compensation {
 public:
  explicit Compensation(const ArmDescription& arm);

  // Begins at the settings of p, with the device at rest.
  void start(const Parameters& p);
  // Takes the device to be at rest, after a while without torque.
  void rest() { v_.setZero(); }
  // True if no setting is being faded over.
  bool steady() const { return steady_; }

  // Returns the torque for the tick that begins [N m], for the arm at `frames` and x. v: velocity
  // estimate; friction: as believed [N m]; `dt`: time since the previous tick [s]. Changed settings
  // fade over within half a second.
  const Vec<N>& step(const Parameters& p, const Arm<N>& arm, const typename Arm<N>::Frames& frames,
                     const Vec<N>& x, const Vec<N>& v, const Vec<N>& friction, double encoder_step,
                     double dt);

 private:
  Vec3 wanted_gravity(const Parameters& p) const;

  Vec3 own_gravity_;        // of the arm's file [m/s^2]
  Vec<N> spring_, offset_;  // [N m/rad, N m]
  Vec3 gravity_ = Vec3::Zero();
  double share_ = 0, springs_ = 0;
  bool steady_ = true;
  Vec<N> v_, torque_;
};

extern template class Compensation<3>;
extern template class Compensation<7>;
extern template class Compensation<kAnyDof>;

}  // namespace limpid
