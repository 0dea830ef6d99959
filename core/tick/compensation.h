// What the device itself pulls with, and the motors take off the hand: weight, springs, and part of
// its friction.
//
// Weight and springs have a potential: what the motors give for them on the way up they get back on
// the way down. Of the friction f_c the torque is s f_c sigma(v), |sigma| <= 1, s < 1. So it never
// puts out more than s f_c |v|, whatever it takes v for, late or noisy, and the device itself takes
// f_c |v| at the same time: motors and friction together stay passive as long as s times what is
// believed is no more than what there is. Near rest sigma is smooth, and v is filtered and wide
// enough for the encoder's steps, so that it does not chatter where the device stands still.
#pragma once

#include "core/dynamics/arm.h"
#include "core/tick/parameters.h"

namespace limpid {

// [m/s^2]; of_arm: as the arm's file has it.
Vec3 gravity_of(Down down, const Vec3& of_arm);

template <int N>
class Compensation {
 public:
  explicit Compensation(const ArmDescription& arm);

  // As it is set, at rest.
  void start(const Parameters& p);
  // The device was without torque for a while: it is taken to be at rest.
  void rest() { v_.setZero(); }
  // Nothing of it is on its way to another setting.
  bool steady() const { return steady_; }

  // Of the tick that begins [N m]: the arm at these frames and x, its velocity estimate v, friction
  // as it is believed to be [N m], `dt` since the tick before [s]. Another setting is gone over to
  // within half a second.
  const Vec<N>& step(const Parameters& p, const Arm<N>& arm, const typename Arm<N>::Frames& frames,
                     const Vec<N>& x, const Vec<N>& v, const Vec<N>& friction, double encoder_step,
                     double dt);

 private:
  Vec3 wanted_gravity(const Parameters& p) const;

  Vec3 own_gravity_;        // as the arm's file has it [m/s^2]
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
