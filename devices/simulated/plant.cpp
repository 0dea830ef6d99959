#include "devices/simulated/plant.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/arm.h"
#include "core/math/elementary.h"
#include "core/tick/tick.h"

namespace limpid {
namespace {

constexpr double kTurn = 2 * 3.14159265358979323846;  // [rad]
constexpr double kCogs = 60;                          // periods of the cogging, a turn of the joint
constexpr double kGear = 10;                          // turns of an encoder, a turn of the joint
constexpr double kRotors = 0.6;                       // see rotors_of() [-]
constexpr double kDamping = 0.03;  // of the transmission, of critical damping [-]
constexpr double kFinest = 0.25;   // a step's length by the transmission's 1/w at most [-]
constexpr int kPoses = 16;

// Pose number k of those that fill an arm's range evenly; joints without limits turn once.
template <int N>
Vec<N> spread_pose(const ArmDescription& arm, int k) {
  constexpr double kGolden = 0.61803398874989485;
  Vec<N> x = Vec<N>::Zero(arm.dof());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Joint& joint = arm.joints[static_cast<std::size_t>(i)];
    const bool ends = std::isfinite(joint.lower) && std::isfinite(joint.upper);
    const double lower = ends ? joint.lower : -kTurn / 2, upper = ends ? joint.upper : kTurn / 2;
    const double share = (k + 0.5) * kGolden * static_cast<double>(i + 1);
    x[i] = lower + (share - std::floor(share)) * (upper - lower);
  }
  return x;
}

// Inertias of the motors: J_m,i = 0.6/(n (M^-1)_ii), the least over the arm's range. As the trace
// of J_m M^-1 is then at most 0.6, at least 0.4 of M is left to the links in every direction.
template <int N>
Vec<N> rotors_of(const ArmDescription& description) {
  const Arm<N> arm(description);
  const int n = description.dof();
  Vec<N> rotors = Vec<N>::Constant(n, HUGE_VAL);
  typename Arm<N>::Frames frames;
  Mat<N> M = Mat<N>::Zero(n, n);
  for (int k = 0; k < kPoses; ++k) {
    arm.frames(spread_pose<N>(description, k), frames);
    arm.inertia(frames, M);
    const Mat<N> inverse = Mat<N>(M.template selfadjointView<Eigen::Lower>()).inverse();
    rotors = rotors.cwiseMin((kRotors / n) * inverse.diagonal().cwiseInverse());
  }
  return rotors;
}

template <int N>
Vec<N> cogging(double amplitude, const Vec<N>& theta) {
  Vec<N> torque = theta;
  for (double& each : torque) each = amplitude * sine(kCogs * each);
  return torque;
}

}  // namespace

template <int N>
Plant<N>::Plant(const ArmDescription& arm)
    : rotors_(rotors_of<N>(arm)),
      damping_(of_joints<N>(arm, &Joint::damping)),
      friction_(of_joints<N>(arm, &Joint::friction)) {
  place(Vec<N>::Zero(arm.dof()), Vec<N>::Zero(arm.dof()));
}

template <int N>
void Plant<N>::place(const Vec<N>& x, const Vec<N>& v) {
  theta_ = x;
  omega_ = v;
  current_ = torque_ = hand_torque_ = Vec<N>::Zero(x.size());
}

template <int N>
Vec<N> Plant<N>::encoders(const Parameters& p, const Vec<N>& x) const {
  Vec<N> shown = p.resonance > 0 ? theta_ : x;
  if (p.eccentricity == 0 && p.zero_error == 0) return shown;
  for (double& each : shown) each += p.eccentricity * sine(kGear * each) + p.zero_error;
  return shown;
}

// Moves the current on by h, exactly; returns its mean [N m].
template <int N>
Vec<N> Plant<N>::current(const Parameters& p, const Vec<N>& wanted, double h) {
  if (p.current_loop == 0) return current_ = wanted;
  const double wh = kTurn * p.current_loop * h, left = exponential(-wh);
  const Vec<N> behind = current_ - wanted;
  current_ = wanted + left * behind;
  return wanted + (1 - left) / wh * behind;
}

template <int N>
void Plant<N>::live(VirtualArm<N>& arm, const Parameters& p, const Vec<N>& torque,
                    const HandInput& hand) {
  const bool yields = p.resonance > 0;
  const Vec<N> wanted = p.torque_scale * torque;
  arm.leave_out(yields ? rotors_ : Vec<N>::Zero(torque.size()));
  if (!yields && p.cogging == 0 && p.current_loop == 0) {
    current_ = torque_ = wanted;
    arm.live(p, wanted, hand);
    hand_torque_ = arm.hand_torque();
    follow(arm);
    return;
  }
  const double w = kTurn * p.resonance;
  const int pieces = std::max(p.substeps, static_cast<int>(std::ceil(w * p.tick / kFinest)));
  Parameters piece = p;
  piece.substeps = 1;
  piece.tick = p.tick / pieces;
  if (yields) piece.damping = piece.friction = piece.unknown_friction = 0;  // are the motors'
  const Vec3 from = arm.target();
  HandInput held = hand;
  torque_.setZero();
  hand_torque_.setZero();
  for (int i = 1; i <= pieces; ++i) {
    const Vec<N> motors = current(p, wanted, piece.tick);
    const Vec<N> drive =
        yields ? transmitted(arm, p, motors, piece.tick)
               : Vec<N>(motors + cogging<N>(p.cogging, arm.x() + piece.tick / 2 * arm.v()));
    const double share = static_cast<double>(i) / pieces;
    held.target = i == pieces ? hand.target : Vec3(from + share * (hand.target - from));
    const Vec<N> before = arm.x();
    arm.live(piece, drive, held);
    torque_ += drive / pieces;
    // Whoever keeps account takes the dampers to be the joints'.
    if (yields) torque_ += resolve<N>(p.damping, damping_).cwiseProduct(arm.x() - before) / p.tick;
    hand_torque_ += arm.hand_torque() / pieces;
  }
  if (!yields) follow(arm);
}

// Moves the motors on by h under this torque; returns the transmission's torque on the joints.
template <int N>
Vec<N> Plant<N>::transmitted(const VirtualArm<N>& arm, const Parameters& p, const Vec<N>& motors,
                             double h) {
  const double w = kTurn * p.resonance;
  const Vec<N> joints = arm.x() + h / 2 * arm.v();
  theta_ += h / 2 * omega_;
  Vec<N> drive =
      rotors_.cwiseProduct(w * w * (theta_ - joints) + 2 * kDamping * w * (omega_ - arm.v()));
  const Vec<N> damping = resolve<N>(p.damping, damping_);
  const Vec<N> friction = resolve<N>(p.friction, friction_).array() + p.unknown_friction;
  const Vec<N> on = motors + cogging<N>(p.cogging, theta_) - drive;
  for (Eigen::Index i = 0; i < on.size(); ++i) {
    const double half = h / 2 * damping[i] / rotors_[i];
    const double free = ((1 - half) * omega_[i] + h / rotors_[i] * on[i]) / (1 + half);
    const double held = h / rotors_[i] * friction[i] / (1 + half);
    omega_[i] = std::copysign(std::max(std::abs(free) - held, 0.0), free);
  }
  theta_ += h / 2 * omega_;
  return drive;
}

template class Plant<3>;
template class Plant<7>;
template class Plant<kAnyDof>;

}  // namespace limpid
