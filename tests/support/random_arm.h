// Random arms and matrices.
#pragma once

#include "core/dynamics/random.h"
#include "core/dynamics/random_arm.h"

namespace limpid::test {

using limpid::random_arm;
using limpid::Slides;

class Random : public limpid::Random {
 public:
  using limpid::Random::Random;

  Eigen::MatrixXd matrix(int n, double size);
  // A symmetric matrix with eigenvalues between low and high.
  Eigen::MatrixXd positive_definite(int n, double low, double high);
};

}  // namespace limpid::test
