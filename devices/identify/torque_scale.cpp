#include "devices/identify/torque_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/math/eigen.h"
#include "devices/identify/fit.h"

namespace limpid {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLeastScale = 0.1, kMostScale = 10;  // believed range
constexpr double kUnsure = 0.2;                       // deviation of the scale that is too large

// The equations of a motion, each divided by its joint's noise.
struct Weighed {
  MatrixXd A;
  VectorXd b;
};

Weighed weighed(const Identified& found, const MotionRecord& record, const FitSettings& settings) {
  const Smoothing window = smoothing_for(record);
  const VectorXd times = independent_times(record, window, settings.longest_delay);
  const Equations rows = equations_of(found.arm, record, settings.gravity, window, times);
  Weighed out{rows.A, rows.of(torque_at(record, window, times, found.delay.value))};
  for (Index i = 0; i < out.b.size(); ++i) {
    const auto joint = static_cast<std::size_t>(rows.joint[static_cast<std::size_t>(i)]);
    const double noise = std::max(found.joints[joint].residual, 1e-9);
    out.A.row(i) /= noise;
    out.b[i] /= noise;
  }
  return out;
}

// The scale s, where A z = b and the last element of z is 1 / s.
Found scale_in(const MatrixXd& A, const VectorXd& b) {
  const LeastSquares fit(A);
  const Index last = A.cols() - 1;
  const double value = 1 / fit.solve(b)[last];
  const double deviation = fit.solution().row(last).norm() * value * value;
  if (!(value > kLeastScale && value < kMostScale) || !(deviation < kUnsure * value)) {
    throw std::invalid_argument(
        fmt::format("the motors' share of the commanded torque is not certain: {:.2g} +- {:.2g}; "
                    "needed: {} to {}, with less uncertainty",
                    value, deviation, kLeastScale, kMostScale));
  }
  return {value, deviation};
}

}  // namespace

Found torque_scale_by_load(const Identified& found, const MotionRecord& bare,
                           const MotionRecord& with_load, double mass,
                           const FitSettings& settings) {
  const Weighed one = weighed(found, bare, settings), two = weighed(found, with_load, settings);
  const Link load{.name = "load", .mass = mass, .com = found.arm.tip.translation()};
  const Index last = kLinkParameters * (found.arm.dof() - 1);
  MatrixXd A = MatrixXd::Zero(one.A.rows() + two.A.rows(), one.A.cols() + 1);
  A.topLeftCorner(one.A.rows(), one.A.cols()) = one.A;
  A.bottomLeftCorner(two.A.rows(), two.A.cols()) = two.A;
  A.col(one.A.cols()).tail(two.A.rows()) =
      two.A.middleCols(last, kLinkParameters) * parameters_of(load);
  VectorXd b(A.rows());
  b << one.b, two.b;
  return scale_in(A, b);
}

Found torque_scale_by_masses(const ArmDescription& file, const Identified& found,
                             const MotionRecord& record, const FitSettings& settings) {
  const Weighed all = weighed(found, record, settings);
  const Index of_links = kLinkParameters * file.dof(), own = all.A.cols() - of_links;
  MatrixXd A(all.A.rows(), own + 1);
  A.leftCols(own) = all.A.rightCols(own);
  A.col(own) = all.A.leftCols(of_links) * parameters_of(file);
  return scale_in(A, all.b);
}

}  // namespace limpid
