#include "app/run/hardness_meter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace limpid {

HardnessMeter::HardnessMeter(const ArmDescription& arm, const Object& wall, double T,
                             std::uint64_t from)
    : arm_(arm),
      point_(wall.pose.translation()),
      out_(std::get<Plane>(wall.shape).normal),
      T_(T),
      from_(from),
      rate_hardness_(std::numeric_limits<double>::quiet_NaN()) {}

void HardnessMeter::add(const RowLayout& layout, std::span<const double> row) {
  const auto vector = [&](Column column) -> Vec<kAnyDof> {
    const auto values = layout.in(row, column);
    return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                             static_cast<Eigen::Index>(values.size()));
  };
  arm_.frames(vector(Column::device_position), frames_);
  const Vec3 tip = arm_.tip(frames_);
  const double depth = out_.dot(point_ - tip);
  arm_.point_jacobian(frames_, arm_.dof() - 1, tip, J_);
  const Mat3 JJ = J_ * J_.transpose();
  const double force = out_.dot(JJ.ldlt().solve(J_ * vector(Column::motor_torque)));
  if (std::isnan(rate_hardness_)) follow(depth, force);
  if (row_++ < from_ || depth <= 0) return;
  ++pressed_;
  const double change = force - mean_;
  mean_ += change / pressed_;
  squares_ += change * (force - mean_);
}

void HardnessMeter::follow(double depth, double force) {
  if (met_) {
    met_->since += T_;
    // A row within round-off of the end of the initial time counts as its end.
    if (met_->since > kInitial * (1 - 1e-9)) {
      rate_hardness_ = (force - met_->force) / met_->since / met_->speed;
    }
    return;
  }
  if (depth > 0 && !depths_.empty()) {
    const double speed = (depth - depths_.back()) / (T_ * static_cast<double>(depths_.size()));
    const double last = depth - depths_.front();  // in the tick in which it met the wall
    met_ = {T_ * depth / last, speed, before_};
    return;
  }
  before_ = force;
  if (depth > 0) return;
  const auto kept = static_cast<std::size_t>(std::max(1.0, std::round(kInitial / T_)));
  depths_.insert(depths_.begin(), depth);
  depths_.resize(std::min(depths_.size(), kept));
}

double HardnessMeter::ripple() const {
  return pressed_ > 0 ? std::sqrt(squares_ / pressed_) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace limpid
