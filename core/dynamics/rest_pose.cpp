#include <algorithm>
#include <cmath>

#include "core/dynamics/arm.h"
#include "core/math/eigen.h"

namespace limpid {
namespace {

using Any = Arm<kAnyDof>;

constexpr double kStretched = 0.1;  // least ratio of the tip's slowest direction to its fastest [-]

// Mobility of the tip in its slowest and fastest direction [m]; with one or two joints, among one
// or two directions.
Eigen::Vector2d mobility(const Any& arm, const Eigen::VectorXd& x) {
  Any::Frames f;
  arm.frames(Vec<kAnyDof>(x), f);
  Jacobian<kAnyDof> J;
  arm.point_jacobian(f, arm.dof() - 1, arm.tip(f), J);
  const Eigen::MatrixXd JJ =
      J.cols() < 3 ? Eigen::MatrixXd(J.transpose() * J) : Eigen::MatrixXd(J * J.transpose());
  const Eigen::VectorXd squares = symmetric_eigen(JJ).values.cwiseMax(0);
  return {std::sqrt(squares[0]), std::sqrt(squares[squares.size() - 1])};
}

}  // namespace

Eigen::VectorXd rest_pose(const ArmDescription& description) {
  const int n = description.dof();
  Eigen::VectorXd x(n);
  for (int i = 0; i < n; ++i) {
    const Joint& joint = description.joints[static_cast<std::size_t>(i)];
    const bool limited = std::isfinite(joint.lower) && std::isfinite(joint.upper);
    x[i] = limited ? (joint.lower + joint.upper) / 2 : 0;
  }
  const Any arm(description);
  const Eigen::Vector2d straight = mobility(arm, x);
  if (straight[0] > kStretched * straight[1]) return x;
  // Bends one joint after the other to where the tip moves best, as few as help, and upwards rather
  // than down.
  const Eigen::VectorXd middle = x;
  double best = straight[0];
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < n; ++i) {
      const Joint& joint = description.joints[static_cast<std::size_t>(i)];
      const double room = 0.4 * (joint.upper - joint.lower);
      for (const double bend : {-0.5, 0.5, -1.0, 1.0}) {
        Eigen::VectorXd tried = x;
        tried[i] = middle[i] + std::clamp(bend, -room, room);
        const double low = arm.tip_at(Vec<kAnyDof>(tried)).z() < 0 ? 0.5 : 1;
        const double now = low * mobility(arm, tried)[0];
        if (now <= 1.2 * best) continue;
        best = now;
        x = tried;
      }
    }
  }
  return x;
}

Vec3 rest_tip(const ArmDescription& description) {
  return Any(description).tip_at(Vec<kAnyDof>(rest_pose(description)));
}

}  // namespace limpid
