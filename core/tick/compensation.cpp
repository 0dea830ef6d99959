#include "core/tick/compensation.h"

#include <algorithm>

namespace limpid {
namespace {

constexpr double kEarth = 9.81;  // [m/s^2]
constexpr double kFade = 0.5;    // from nothing to full compensation [s]

// Constants of sigma(v), which is 0.7 at kSlow for exact encoders, at more with steps. v is
// filtered for as long as kSteps of them take at kPace, within bounds; a flicker of one step is
// then a sixth of that velocity.
constexpr double kSlow = 0.05, kPace = 0.1;                 // [rad/s]
constexpr double kSteps = 3;                                // [-]
constexpr double kLeastSmooth = 0.003, kMostSmooth = 0.02;  // [s]

}  // namespace

Vec3 gravity_of(Down down, const Vec3& of_arm) {
  if (down == Down::as_file) return of_arm;
  const int i = static_cast<int>(down) - 1;  // -z, +z, -x, ...
  return (i % 2 == 0 ? -kEarth : kEarth) * Vec3::Unit((2 + i / 2) % 3);
}

template <int N>
Compensation<N>::Compensation(const ArmDescription& arm)
    : own_gravity_(arm.gravity),
      spring_(of_joints<N>(arm, &Joint::spring)),
      offset_(of_joints<N>(arm, &Joint::offset)),
      v_(Vec<N>::Zero(arm.dof())),
      torque_(v_) {}

template <int N>
Vec3 Compensation<N>::wanted_gravity(const Parameters& p) const {
  return p.holds_weight ? gravity_of(p.down, own_gravity_) : Vec3::Zero();
}

template <int N>
void Compensation<N>::start(const Parameters& p) {
  gravity_ = wanted_gravity(p);
  share_ = p.friction_share;
  springs_ = p.holds_springs ? 1 : 0;
  steady_ = true;
  rest();
}

template <int N>
const Vec<N>& Compensation<N>::step(const Parameters& p, const Arm<N>& arm,
                                    const typename Arm<N>::Frames& frames, const Vec<N>& x,
                                    const Vec<N>& v, const Vec<N>& friction, double encoder_step,
                                    double dt) {
  const double most = dt / kFade;
  steady_ = true;
  const auto approach = [&](double& value, double wanted) {
    value += std::clamp(wanted - value, -most, most);
    steady_ = steady_ && value == wanted;
  };
  approach(share_, p.friction_share);
  approach(springs_, p.holds_springs ? 1 : 0);
  const Vec3 left = wanted_gravity(p) - gravity_;
  const double step = kEarth * most;
  steady_ = steady_ && left.isZero(0);
  gravity_ = left.norm() <= step ? wanted_gravity(p) : Vec3(gravity_ + step / left.norm() * left);

  torque_.setZero();
  if (!gravity_.isZero(0)) torque_ += arm.weight(frames, gravity_);
  if (springs_ > 0) torque_ += springs_ * (spring_.cwiseProduct(x) + offset_);
  const double steps = kSteps * encoder_step;  // [rad]
  const double smooth = std::clamp(steps / kPace, kLeastSmooth, kMostSmooth);
  v_ += dt / (smooth + dt) * (v - v_);
  if (share_ > 0) {
    const double width = kSlow + steps / smooth;
    const auto sigma = v_.array() / (v_.array().square() + width * width).sqrt();
    torque_ += (share_ * friction.array() * sigma).matrix();
  }
  return torque_;
}

template class Compensation<3>;
template class Compensation<7>;
template class Compensation<kAnyDof>;

}  // namespace limpid
