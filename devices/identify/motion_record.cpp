#include "devices/identify/motion_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace limpid {
namespace {

struct Rows {
  Eigen::Index first, last;  // inclusive
};

Rows rows_about(const MotionRecord& record, const Smoothing& window, double time) {
  const auto at = [&](double t) {
    return std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::llround(t / record.T)), 0,
                                    record.rows() - 1);
  };
  return {at(time - window.reach()), at(time + window.reach())};
}

}  // namespace

Eigen::VectorXd encoder_steps(const MotionRecord& record) {
  Eigen::VectorXd step =
      Eigen::VectorXd::Constant(record.joints(), std::numeric_limits<double>::infinity());
  for (Eigen::Index i = 1; i < record.rows(); ++i) {
    for (Eigen::Index j = 0; j < record.joints(); ++j) {
      const double moved = std::abs(record.x(i, j) - record.x(i - 1, j));
      if (moved > 1e-9) step[j] = std::min(step[j], moved);
    }
  }
  return step;
}

Smoothing smoothing_for(const MotionRecord& record) {
  constexpr double kNoise = 3e-4;
  const Eigen::VectorXd step = encoder_steps(record);
  for (const double sigma : {0.008, 0.010}) {
    const Smoothing window{sigma};
    // Noise gain: white noise of step^2 / 12 a row, through the second derivative of the Gaussian.
    const double passed = record.T * 3 / (8 * std::sqrt(std::numbers::pi) * std::pow(sigma, 5));
    const double length = static_cast<double>(record.rows()) * record.T - 2 * window.reach();
    const auto count = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(length / sigma));
    const Motion3 motion = motion_at(
        record, window, Eigen::VectorXd::LinSpaced(count, window.reach(), window.reach() + length));
    const Eigen::ArrayXd square = motion.a.array().square().colwise().mean().transpose();
    if ((step.array().square() / 12 * passed < kNoise * square).all()) return window;
  }
  return {0.0125};
}

Motion3 motion_at(const MotionRecord& record, const Smoothing& window,
                  const Eigen::VectorXd& times) {
  const Eigen::Index n = record.joints();
  Motion3 out{Eigen::MatrixXd::Zero(times.size(), n), Eigen::MatrixXd::Zero(times.size(), n),
              Eigen::MatrixXd::Zero(times.size(), n)};
  const double s2 = window.sigma * window.sigma;
  for (Eigen::Index k = 0; k < times.size(); ++k) {
    const auto [first, last] = rows_about(record, window, times[k]);
    // Positions are taken relative to the middle row, so that derivatives are no small differences
    // of large numbers.
    const Eigen::RowVectorXd middle = record.x.row((first + last) / 2);
    double weight = 0;
    for (Eigen::Index i = first; i <= last; ++i) {
      const double t = times[k] - static_cast<double>(i) * record.T;
      const double g = std::exp(-0.5 * t * t / s2);
      const Eigen::RowVectorXd from_middle = record.x.row(i) - middle;
      weight += g;
      out.x.row(k) += g * from_middle;
      out.v.row(k) -= g * t / s2 * from_middle;
      out.a.row(k) += g * (t * t / s2 - 1) / s2 * from_middle;
    }
    out.x.row(k) = middle + out.x.row(k) / weight;
    out.v.row(k) /= weight;
    out.a.row(k) /= weight;
  }
  return out;
}

// A torque that is held for a tick is weighted by the window's integral over the tick.
Eigen::MatrixXd torque_at(const MotionRecord& record, const Smoothing& window,
                          const Eigen::VectorXd& times, double delay) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(times.size(), record.joints());
  const double scale = 1 / (window.sigma * std::numbers::sqrt2);
  for (Eigen::Index k = 0; k < times.size(); ++k) {
    const double time = times[k] - delay;
    const auto [first, last] = rows_about(record, window, time);
    double before = std::erf((static_cast<double>(first) * record.T - time) * scale);
    const double lowest = before;
    for (Eigen::Index i = first; i <= last; ++i) {
      const double after = std::erf((static_cast<double>(i + 1) * record.T - time) * scale);
      out.row(k) += (after - before) * record.torque.row(i);
      before = after;
    }
    out.row(k) /= before - lowest;
  }
  return out;
}

}  // namespace limpid
