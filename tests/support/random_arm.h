// Arms without symmetries: no axis parallel to another, nothing at an origin, no two links alike.
#pragma once

#include <Eigen/QR>
#include <cmath>
#include <random>
#include <string>

#include "core/dynamics/arm_description.h"

namespace limpid::test {

// Numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967295.0;
  }
  Vec3 point(double size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }
  Vec3 direction() {
    Vec3 d = point(1);
    while (d.norm() < 0.1 || d.norm() > 1) d = point(1);
    return d.normalized();
  }
  Mat3 rotation() { return Eigen::AngleAxisd(between(-3, 3), direction()).toRotationMatrix(); }
  Eigen::VectorXd vector(int n, double size) {
    Eigen::VectorXd v(n);
    for (double& c : v) c = between(-size, size);
    return v;
  }
  Eigen::MatrixXd matrix(int n, double size) {
    Eigen::MatrixXd A(n, n);
    for (double& c : A.reshaped()) c = between(-size, size);
    return A;
  }
  // Symmetric, with eigenvalues between low and high.
  Eigen::MatrixXd positive_definite(int n, double low, double high) {
    const Eigen::MatrixXd Q = matrix(n, 1).householderQr().householderQ();
    Eigen::VectorXd d(n);
    for (double& c : d) c = between(low, high);
    return Q * d.asDiagonal() * Q.transpose();
  }

 private:
  std::mt19937 engine_;
};

// Which joints of a random arm are slides: none, every third from the second on, or all.
enum class Slides { none, some, all };

// Links of about 0.1 m and 0.05 kg each, as of a desktop device. Inertias are those of real
// bodies: of four point masses.
inline ArmDescription random_arm(int dof, unsigned seed, Slides slides = Slides::none) {
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
