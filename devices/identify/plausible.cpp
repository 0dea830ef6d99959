#include "devices/identify/plausible.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace limpid {
namespace {

using Eigen::Matrix4d;

Matrix4d pseudo_inertia(const LinkParameters& p) {
  const double half = 0.5 * (p[4] + p[7] + p[9]);
  Matrix4d J;
  J << half - p[4], -p[5], -p[6], p[1],  //
      -p[5], half - p[7], -p[8], p[2],   //
      -p[6], -p[8], half - p[9], p[3],   //
      p[1], p[2], p[3], p[0];
  return J;
}

LinkParameters parameters_of(const Matrix4d& J) {
  const double trace = J(0, 0) + J(1, 1) + J(2, 2);
  LinkParameters p;
  p << J(3, 3), J(0, 3), J(1, 3), J(2, 3), trace - J(0, 0), -J(0, 1), -J(0, 2), trace - J(1, 1),
      -J(1, 2), trace - J(2, 2);
  return p;
}

Matrix4d triangle(const LinkParameters& d) {
  Matrix4d E = Matrix4d::Zero();
  Eigen::Index k = 0;
  for (Eigen::Index j = 0; j < 4; ++j) {
    E(j, j) = std::exp(d[k++]);
    for (Eigen::Index i = j + 1; i < 4; ++i) E(i, j) = d[k++];
  }
  return E;
}

}  // namespace

PlausibleLink::PlausibleLink(const LinkParameters& guess) {
  Matrix4d J = pseudo_inertia(guess);
  // In units in which all of a body is about one: its mass and its size squared.
  const double mass = std::max(guess[0], 1e-9);
  const double size2 = std::max(J.topLeftCorner<3, 3>().trace() / mass, 1e-8);
  Eigen::Vector4d unit = Eigen::Vector4d::Constant(std::sqrt(mass * size2));
  unit[3] = std::sqrt(mass);
  Matrix4d scaled = unit.cwiseInverse().asDiagonal() * J * unit.cwiseInverse().asDiagonal();
  for (double more = 1e-3;; more *= 2) {
    const Eigen::LLT<Matrix4d> factor(scaled);
    const Matrix4d L = factor.matrixL();
    if (factor.info() == Eigen::Success && L.diagonal().minCoeff() > 0.01) {
      L0_ = unit.asDiagonal() * L;
      return;
    }
    scaled.diagonal().array() += more;
  }
}

LinkParameters PlausibleLink::at(const LinkParameters& d) const {
  const Matrix4d L = L0_ * triangle(d);
  return parameters_of(Matrix4d(L * L.transpose()));
}

Eigen::Matrix<double, kLinkParameters, kLinkParameters> PlausibleLink::slope(
    const LinkParameters& d) const {
  const Matrix4d E = triangle(d);
  Eigen::Matrix<double, kLinkParameters, kLinkParameters> out;
  Eigen::Index k = 0;
  for (Eigen::Index j = 0; j < 4; ++j) {
    for (Eigen::Index i = j; i < 4; ++i) {
      Matrix4d dE = Matrix4d::Zero();
      dE(i, j) = i == j ? E(j, j) : 1;
      const Matrix4d half = L0_ * dE * E.transpose() * L0_.transpose();
      out.col(k++) = parameters_of(Matrix4d(half + half.transpose()));
    }
  }
  return out;
}

}  // namespace limpid
