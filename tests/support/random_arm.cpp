#include "tests/support/random_arm.h"

#include <Eigen/QR>

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

}  // namespace limpid::test
