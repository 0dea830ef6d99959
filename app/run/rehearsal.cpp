#include "app/run/rehearsal.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/eigen.h"
#include "core/math/elementary.h"
#include "devices/simulated/rig.h"

namespace limpid {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFadeIn = 1;                  // of the force, at rest [s]
constexpr double kPress = 3, kFree = 6;        // [s]
constexpr double kStop = 0.05, kDepth = 0.15;  // from rest to the stop, and from there on [rad]
constexpr double kStopStiffness = 2;           // [N m/rad]
constexpr double kSwing = 0.12, kSlow = 1.3, kFast = 4.1;  // [rad], [Hz]
constexpr double kLeastSpeed = 0.05;                       // of motion [rad/s]
constexpr double kTwoPi = 2 * 3.14159265358979323846;

// True motion of the device, a row a tick.
struct Truth {
  std::vector<VectorXd> x, v, hand;
};

class Stand {
 public:
  Stand(const ArmDescription& truth, const Unlikeness& bench, const ArmDescription& believed,
        const Parameters& p, const Scene& scene)
      : device_(truth, bench),
        rig_(believed, scene, nullptr),
        arm_(truth),
        p_(p),
        damping_(of_joints<kAnyDof>(truth, &Joint::damping)),
        proxy_damping_(p.b_v * gain_weights(p, device_damping(believed, p))) {
    rest_ = rest_pose(truth);
    device_.put(rest_);
    const VectorXd zero = VectorXd::Zero(rest_.size());
    rig_.start(p, {rest_, zero, rest_, zero, zero, arm_.tip_at(rest_), false});
    rig_.plug(&device_);
    row_.resize(static_cast<std::size_t>(rig_.layout().stride()));
    given_.assign(static_cast<std::size_t>(bench.delay) + 1, zero);
    x2_ = rest_;
    tau2_ = zero;
  }

  // Runs one tick, the hand's target where the tip is at this pose.
  void step(const VectorXd& wanted) {
    RigInput input{{arm_.tip_at(Vec<kAnyDof>(wanted)), 1}};
    if (ticks_ == 0) input.force = ForceRequest::arm;
    const VectorXd x1 = device_.arm().x();
    rig_.step(p_, input, row_);
    keep_books(device_.arm().x() - x1);
    ++ticks_;
    if (ticks_ * p_.tick > kFadeIn) force_ = force_ && rig_.force_state() == ForceState::on;
  }
  VectorXd at(Column c) const {
    const auto values = rig_.layout().in(std::span<const double>(row_), c);
    return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
  }

  const VectorXd& rest() const { return rest_; }
  const VirtualArm<kAnyDof>& truth() const { return device_.arm(); }
  const Arm<kAnyDof>& arm() const { return arm_; }
  const VectorXd& damping() const { return damping_; }
  // The proxy's, by gains that fit the arm that the loop believes in [N m s/rad].
  const VectorXd& proxy_damping() const { return proxy_damping_; }
  double energy() const { return most_; }
  bool force() const { return force_; }

 private:
  // Adds up E_c of the law alone. The proxy's part is of the tick before this one, the last that
  // has ended.
  void keep_books(const VectorXd& dx1) {
    std::rotate(given_.begin(), given_.end() - 1, given_.end());
    given_.front() =
        at(Column::motor_torque) - rig_.force().gain() * at(Column::compensation_torque);
    energy_ += given_.back().dot(dx1) - damping_.cwiseProduct(dx1).dot(dx1) / p_.tick;
    energy_ += tau2_.dot(at(Column::proxy_position) - x2_);
    x2_ = at(Column::proxy_position);
    tau2_ = at(Column::proxy_torque);
    most_ = std::max(most_, energy_);
  }

  UnlikeDevice device_;
  Rig rig_;
  Arm<kAnyDof> arm_;
  Parameters p_;
  VectorXd damping_, proxy_damping_, rest_, x2_, tau2_;
  std::vector<VectorXd> given_;  // by the law, the newest first [N m]
  std::vector<double> row_;
  bool force_ = true;
  int ticks_ = 0;
  double energy_ = 0, most_ = 0;
};

// Presses the first joint against a stop, deeper and deeper.
void press(Stand& stand, const Parameters& p, Rehearsal& result) {
  double ef = 0, ff = 0;
  for (double t = 0; t < kFadeIn + kPress; t += p.tick) {
    const double s = std::clamp((t - kFadeIn) / kPress, 0.0, 1.0);
    VectorXd wanted = stand.rest();
    wanted[0] += s * (kStop + kDepth);
    stand.step(wanted);
    const double f = stand.at(Column::contact_torque).norm();
    const VectorXd apart = stand.at(Column::measured_position) - stand.at(Column::proxy_position);
    ef += apart.norm() * f;
    ff += f * f;
  }
  result.slope = ff > 0 ? ef / ff : 0;
}

void swing(Stand& stand, const Parameters& p, Truth& truth) {
  for (double t = 0; t < kFadeIn + kFree; t += p.tick) {
    const double u = std::max(0.0, t - kFadeIn), begin = std::min(1.0, u);
    VectorXd wanted = stand.rest();
    for (Index j = 0; j < wanted.size(); ++j) {
      wanted[j] += kSwing * begin *
                   (sine(kTwoPi * kSlow * u + static_cast<double>(j)) -
                    0.5 * cosine(kTwoPi * kFast * u + 2 * static_cast<double>(j)));
    }
    stand.step(wanted);
    if (u < 1) continue;
    truth.x.emplace_back(stand.truth().x());
    truth.v.emplace_back(stand.truth().v());
    truth.hand.emplace_back(stand.truth().hand_torque());
  }
}

// Factors on inertia and damping that the law promises to leave felt [-].
struct PromisedShare {
  double inertia, damping;
};
PromisedShare promise(const Parameters& p) {
  if (!info(p.kind).takes_eta) return {1, 1};
  return {p.eta, info(p.kind).observes ? p.eta : p.damping_share(p.eta)};
}

// Fits the hand's torque, a row a tick and joint: by inertia, damping, friction, and weight and
// spring of each joint.
void explain_what_is_felt(const Truth& truth, const Stand& stand, const Parameters& p,
                          Rehearsal& result) {
  const Index n = stand.rest().size(), ticks = static_cast<Index>(truth.x.size()) - 1;
  const PromisedShare promised = promise(p);
  MatrixXd A = MatrixXd::Zero(n * ticks, 3 + 2 * n);
  VectorXd b = VectorXd::Zero(n * ticks);
  Arm<kAnyDof>::Frames frames;
  Mat<kAnyDof> M, C;
  double missed = 0, whole = 0;
  for (Index k = 0; k < ticks; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Vec<kAnyDof> x = 0.5 * (truth.x[i] + truth.x[i + 1]);
    const Vec<kAnyDof> v = 0.5 * (truth.v[i] + truth.v[i + 1]);
    stand.arm().frames(x, frames);
    stand.arm().inertia_coriolis(frames, v, M, C);
    const VectorXd inertia = M * (truth.v[i + 1] - truth.v[i]) / p.tick + C * v;
    const VectorXd damping = (stand.damping() + stand.proxy_damping()).cwiseProduct(v);
    const VectorXd wanted = promised.inertia * inertia + promised.damping * damping;
    missed += (truth.hand[i + 1] - wanted).squaredNorm();
    whole += wanted.squaredNorm();
    for (Index j = 0; j < n; ++j) {
      if (std::abs(v[j]) < kLeastSpeed) continue;
      A.row(n * k + j) << inertia[j], damping[j], v[j] > 0 ? 1 : -1, Eigen::RowVectorXd::Unit(n, j),
          (x[j] - stand.rest()[j]) * Eigen::RowVectorXd::Unit(n, j);
      b[n * k + j] = truth.hand[i + 1][j];
    }
  }
  const VectorXd found = least_squares(A, b);
  result.off = std::sqrt(missed / whole);
  result.friction = found[2];
  result.weight = found.segment(3, n).norm() / std::sqrt(static_cast<double>(n));
}

}  // namespace

Rehearsal rehearse(const ArmDescription& truth, const Unlikeness& bench,
                   const ArmDescription& believed, const Parameters& p) {
  Rehearsal result;
  Scene stop;
  stop.add({.name = "stop",
            .shape = JointStop{0, rest_pose(truth)[0] + kStop, 1},
            .material = {kStopStiffness}});
  Stand pressed(truth, bench, believed, p, stop);
  press(pressed, p, result);
  Stand free(truth, bench, believed, p, Scene{});
  Truth motion;
  swing(free, p, motion);
  explain_what_is_felt(motion, free, p, result);
  result.energy = std::max(pressed.energy(), free.energy());
  result.force = pressed.force() && free.force();
  return result;
}

}  // namespace limpid
