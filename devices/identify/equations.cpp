#include "devices/identify/equations.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace limpid {
namespace {

using Eigen::Index;

constexpr double kLeastSpeed = 0.05;  // that is motion [rad/s]

// About that time the joint moves in the direction of v all along, faster than one that sticks or
// an encoder that flickers.
bool moves_on(const MotionRecord& record, const Smoothing& window, double time, Index joint,
              double v, double step) {
  const double piece = std::max(window.sigma, 0.01);
  const double least = std::max(1.5 * step, kLeastSpeed * piece);
  const auto at = [&](double t) {
    const auto row = static_cast<Index>(std::llround(t / record.T));
    return record.x(std::clamp<Index>(row, 0, record.rows() - 1), joint);
  };
  const double edge = 3 * window.sigma;
  for (double t = time - edge; t < time + edge - 1e-9; t += piece) {
    const double moved = at(t + piece) - at(t);
    if (!(v > 0 ? moved >= least : moved <= -least)) return false;
  }
  return true;
}

}  // namespace

Eigen::VectorXd independent_times(const MotionRecord& record, const Smoothing& window,
                                  double longest_delay) {
  const double margin = 1.5 * window.reach() + longest_delay;
  const double spacing = window.independent();
  const double length = static_cast<double>(record.rows()) * record.T - 2 * margin;
  if (length < spacing) throw std::invalid_argument("the recorded motion is too short");
  const auto count = static_cast<Index>(length / spacing);
  return Eigen::VectorXd::LinSpaced(count, margin,
                                    margin + static_cast<double>(count - 1) * spacing);
}

Equations equations_of(const ArmDescription& guess, const MotionRecord& record, const Vec3& gravity,
                       const Smoothing& window, const Eigen::VectorXd& times) {
  const Motion3 motion = motion_at(record, window, times);
  const Eigen::VectorXd step = encoder_steps(record);
  const Arm<kAnyDof> arm(guess);
  const Index n = record.joints(), of_links = kLinkParameters * n;
  Equations out;
  std::vector<Eigen::RowVectorXd> lines;
  for (Index k = 0; k < times.size(); ++k) {
    const Eigen::MatrixXd Y =
        regressor(arm, motion.x.row(k).transpose(), motion.v.row(k).transpose(),
                  motion.a.row(k).transpose(), gravity);
    for (Index j = 0; j < n; ++j) {
      const double v = motion.v(k, j);
      if (!moves_on(record, window, times[k], j, v, step[j])) continue;
      Eigen::RowVectorXd line = Eigen::RowVectorXd::Zero(of_links + kOwnParameters * n);
      line.head(of_links) = Y.row(j);
      line.segment<kOwnParameters>(of_links + kOwnParameters * j) << v, v > 0 ? 1 : -1, 1,
          motion.x(k, j);
      lines.push_back(std::move(line));
      out.time.push_back(k);
      out.joint.push_back(j);
    }
  }
  out.A.resize(static_cast<Index>(lines.size()), of_links + kOwnParameters * n);
  for (Index i = 0; i < out.A.rows(); ++i) out.A.row(i) = lines[static_cast<std::size_t>(i)];
  return out;
}

Eigen::VectorXd Equations::of(const Eigen::MatrixXd& torque) const {
  Eigen::VectorXd b(A.rows());
  for (Index i = 0; i < b.size(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    b[i] = torque(time[row], joint[row]);
  }
  return b;
}

}  // namespace limpid
