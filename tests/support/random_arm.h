// Arms without symmetries: no axis parallel to another, nothing at an origin, no two links alike.
#pragma once

#include <random>

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
  Eigen::MatrixXd matrix(int n, double size);
  // Symmetric, with eigenvalues between low and high.
  Eigen::MatrixXd positive_definite(int n, double low, double high);

 private:
  std::mt19937 engine_;
};

// Which joints of a random arm are slides: none, every third from the second on, or all.
enum class Slides { none, some, all };

// Links of about 0.1 m and 0.05 kg each, as of a desktop device. Inertias are those of real
// bodies: of four point masses.
ArmDescription random_arm(int dof, unsigned seed, Slides slides = Slides::none);

}  // namespace limpid::test
