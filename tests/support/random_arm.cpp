#include "tests/support/random_arm.h"

#include <Eigen/QR>
#include <string>

namespace limpid::test {

Eigen::MatrixXd Random::matrix(int n, double size) {
  Eigen::MatrixXd A(n, n);
  for (double& c : A.reshaped()) c = between(-size, size);
  return A;
}

Eigen::MatrixXd Random::positive_definite(int n, double low, double high) {
  const Eigen::MatrixXd Q = matrix(n, 1).householderQr().householderQ();
  Eigen::VectorXd d(n);
  for (double& c : d) c = between(low, high);
  return Q * d.asDiagonal() * Q.transpose();
}

ArmDescription random_arm(int dof, unsigned seed, Slides slides) {
  Random random(seed);
  ArmDescription arm;
  arm.name = "random";
  for (int i = 0; i < dof; ++i) {
    const std::string number = std::to_string(i + 1);
    Joint joint;
    joint.name = "joint " + number;
    joint.origin.linear() = random.rotation();
    joint.origin.translation() = (i == 0 ? 0.02 : 0.1) * random.direction();
    joint.axis = random.direction();
    joint.effort = random.between(0.4, 0.8);
    joint.damping = 0.012;
    if (slides == Slides::all || (slides == Slides::some && i % 3 == 1)) {
      joint.kind = Joint::Kind::prismatic;
    }
    arm.joints.push_back(joint);

    Link link;
    link.name = "link " + number;
    link.mass = random.between(0.03, 0.07);
    link.com = random.point(0.03);
    for (int k = 0; k < 4; ++k) {
      const Vec3 r = random.point(0.04);
      link.inertia += link.mass / 4 * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
    }
    arm.links.push_back(link);
    arm.frames.push_back({link.name, i, Pose::Identity()});
  }
  arm.tip.translation() = 0.1 * random.direction();
  return arm;
}

}  // namespace limpid::test
