#include "app/run/divergence.h"

#include <fmt/format.h>

#include <cmath>

namespace limpid {
namespace {

constexpr double kWildSpeed = 1e3;   // [rad/s]
constexpr double kWildTorque = 1e4;  // [N m]
constexpr double kWildError = 10;    // [rad]
constexpr double kLost = 1e3;        // times those
constexpr std::uint64_t kCalm = 10;  // rows; what swings ever higher passes through small values

struct Excess {
  double times = 0;  // of what is wild; not a number where the value is none
  int joint = 0;     // from 0
  Column column = Column::device_velocity;
};

bool beyond(const Excess& e, double times) { return !(e.times <= times); }

// The furthest beyond its limit.
Excess largest(const RowLayout& layout, std::span<const double> row) {
  Excess most;
  const auto look = [&](Column column, int joint, double value, double limit) {
    if (std::abs(value) <= limit) return;  // as in nearly every row: nothing to divide
    const double times = std::abs(value) / limit;
    if (std::isnan(most.times) || times <= most.times) return;
    most = {times, joint, column};
  };
  for (int i = 0; i < layout.dof(); ++i) {
    const auto at = [&](Column c) { return layout.in(row, c)[static_cast<std::size_t>(i)]; };
    look(Column::commanded_torque, i, at(Column::commanded_torque), kWildTorque);
    look(Column::device_velocity, i, at(Column::device_velocity), kWildSpeed);
    look(Column::proxy_velocity, i, at(Column::proxy_velocity), kWildSpeed);
    look(Column::proxy_position, i, at(Column::device_position) - at(Column::proxy_position),
         kWildError);
  }
  return most;
}

std::string in_words(const Excess& e) {
  struct Words {
    const char* what;
    double limit;
    const char* unit;
  };
  const auto words = [&]() -> Words {
    switch (e.column) {
      case Column::commanded_torque: return {"the torque asked of joint", kWildTorque, "N m"};
      case Column::proxy_velocity: return {"the speed of the proxy's joint", kWildSpeed, "rad/s"};
      case Column::proxy_position:
        return {"the distance of device and proxy in joint", kWildError, "rad"};
      default: return {"the speed of the device's joint", kWildSpeed, "rad/s"};
    }
  }();
  if (!std::isfinite(e.times)) return fmt::format("{} {} is not finite", words.what, e.joint + 1);
  return fmt::format("{} {} grew beyond {:.0f} {}", words.what, e.joint + 1, words.limit,
                     words.unit);
}

}  // namespace

void DivergenceWatch::add(std::span<const double> row) {
  const std::uint64_t k = rows_++;
  if (lost_) return;
  const Excess excess = largest(layout_, row);
  if (!beyond(excess, 1)) {
    if (k >= wild_row_ + kCalm) why_.clear();
    return;
  }
  wild_row_ = k;
  if (why_.empty()) {
    since_row_ = k;
    since_ = layout_.in(row, Column::time)[0];
    why_ = in_words(excess);
  }
  lost_ = lost_ || beyond(excess, kLost);
}

}  // namespace limpid
