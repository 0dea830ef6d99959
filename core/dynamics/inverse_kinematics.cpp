#include "core/dynamics/inverse_kinematics.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

#include "core/dynamics/arm.h"

namespace limpid {
namespace {

using Any = Arm<kAnyDof>;
constexpr double kPi = 3.14159265358979323846;

// Damped least squares from one starting point, within the limits.
std::optional<Eigen::VectorXd> descend(const ArmDescription& description, const Any& arm,
                                       const Vec3& target, const Eigen::VectorXd& start) {
  Vec<kAnyDof> x = start;
  Any::Frames f;
  Jacobian<kAnyDof> J;
  double damping = 1e-3;
  const double size = reach(description);
  const auto error_at = [&](const Vec<kAnyDof>& at) {
    arm.frames(at, f);
    return Vec3(target - arm.tip(f));
  };
  Vec3 error = error_at(x);
  for (int i = 0; i < 200; ++i) {
    if (error.norm() < 1e-12 * size) break;
    error = error_at(x);
    arm.point_jacobian(f, arm.dof() - 1, arm.tip(f), J);
    Mat3 A = J * J.transpose();
    A.diagonal().array() += damping * damping * size * size;
    Vec<kAnyDof> next = x + J.transpose() * A.ldlt().solve(error);
    for (int j = 0; j < arm.dof(); ++j) {
      const Joint& joint = description.joints[static_cast<std::size_t>(j)];
      next[j] = std::clamp(next[j], joint.lower, joint.upper);
    }
    const Vec3 next_error = error_at(next);
    if (next_error.norm() < error.norm()) {
      x = next;
      error = next_error;
      damping = std::max(damping / 4, 1e-9);
    } else {
      damping *= 4;
    }
  }
  if (error.norm() > 1e-6) return std::nullopt;
  return Eigen::VectorXd(x);
}

}  // namespace

std::optional<Eigen::VectorXd> inverse_kinematics(const ArmDescription& description,
                                                  const Vec3& target,
                                                  const Eigen::VectorXd& guess) {
  const Any arm(description);
  if (auto x = descend(description, arm, target, guess)) return x;
  std::mt19937 random(1);  // the same answer every time
  for (int attempt = 0; attempt < 50; ++attempt) {
    Eigen::VectorXd start(description.dof());
    for (int j = 0; j < description.dof(); ++j) {
      const Joint& joint = description.joints[static_cast<std::size_t>(j)];
      const double lower = std::max(joint.lower, -kPi);
      const double upper = std::min(joint.upper, kPi);
      start[j] = lower + (upper - lower) * static_cast<double>(random()) / 4294967295.0;
    }
    if (auto x = descend(description, arm, target, start)) return x;
  }
  return std::nullopt;
}

double reach(const ArmDescription& arm) {
  double length = 0;
  // Span from one revolute joint to the next: slides between them keep their directions and span a
  // box.
  Vec3 least = Vec3::Zero(), most = Vec3::Zero();
  Mat3 turned = Mat3::Identity();
  const auto add = [&](const Vec3& one, const Vec3& other) {
    least += (turned * one).cwiseMin(turned * other);
    most += (turned * one).cwiseMax(turned * other);
  };
  const auto end = [&] {
    length += least.cwiseAbs().cwiseMax(most.cwiseAbs()).norm();
    least.setZero();
    most.setZero();
    turned.setIdentity();
  };
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    const Joint& joint = arm.joints[i];
    if (i > 0) add(joint.origin.translation(), joint.origin.translation());
    turned = turned * joint.origin.linear();
    if (joint.kind == Joint::Kind::revolute) {
      end();
    } else if (std::isfinite(joint.lower) && std::isfinite(joint.upper)) {
      add(kSlideUnit * joint.lower * joint.axis, kSlideUnit * joint.upper * joint.axis);
    }
  }
  add(arm.tip.translation(), arm.tip.translation());
  end();
  return length;
}

}  // namespace limpid
