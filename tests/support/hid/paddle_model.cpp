#include "tests/support/hid/paddle_model.h"

#include <cmath>

namespace limpid::test {
namespace {

// Pins of the encoder at a count; one step changes one of the two.
std::uint8_t pins_of(long count) {
  constexpr std::array<std::uint8_t, 4> gray{0, 1, 3, 2};
  return gray[static_cast<std::size_t>(count & 3)];
}

std::uint64_t us(Time time) { return static_cast<std::uint64_t>(time.count() / 1000); }

}  // namespace

AxisPhysics PaddleModel::paddle_axis() {
  AxisPhysics axis;
  axis.inertia = 7.0e-4;
  axis.friction = 0.035;
  axis.lower = paddle_build.lower;
  axis.upper = paddle_build.upper;
  return axis;
}

PaddleModel::PaddleModel(const AxisPhysics& physics)
    : ReferenceDevice({"Limpid paddle", 0x1209, 0x4C50, ""},
                      Report(paddle_descriptor, paddle_descriptor + PADDLE_DESCRIPTOR),
                      std::chrono::microseconds(PADDLE_PERIOD_US)),
      hand_({physics}) {}

void PaddleModel::restart(Time now) {
  start_ = now;
  hand_.begin(now);
  paddle_begin(&firmware_, &paddle_build, 0);
  count_ = std::lround((hand_.position(0) - paddle_build.lower) * paddle_build.counts);
  firmware_.pins = pins_of(count_);
}

void PaddleModel::turn_encoder() {
  const long there = std::lround((hand_.position(0) - paddle_build.lower) * paddle_build.counts);
  while (count_ != there) {
    count_ += count_ < there ? 1 : -1;
    if (skipping_ > 0 && skipping_-- > 0) continue;
    see(pins_of(count_));
  }
}

void PaddleModel::see(std::uint8_t pins) {
  const int seen = (pins & ~broken_) | (firmware_.pins & broken_);
  paddle_turn(&firmware_, static_cast<std::uint8_t>(seen));
}

// The board's loop and the paddle's mechanics, in steps of 0.1 ms.
void PaddleModel::run(Time now) {
  hand_.run(now, [&](Time step) {
    turn_encoder();
    if (at_end_) {  // the move to the end and back is faster than a step
      for (long at = count_; at > 0; --at) paddle_turn(&firmware_, pins_of(at - 1));
      paddle_inputs(&firmware_, true, hand_.held(), driver_fault_);
      for (long at = 0; at < count_; ++at) paddle_turn(&firmware_, pins_of(at + 1));
      at_end_ = false;
    }
    paddle_inputs(&firmware_, false, hand_.held(), driver_fault_);
    const bool cut = firmware_.cut;
    const double wires = swapped_ ? -paddle_build.peak : paddle_build.peak;
    const Torque torque{static_cast<double>(paddle_drive(&firmware_, us(step - start_))) * wires};
    if (torque != forces().newest()) {
      forces().note(step, torque, firmware_.cut && !cut ? ForceCause::watchdog : ForceCause::told);
    }
    return torque;
  });
}

std::vector<Report> PaddleModel::next_input(Time now) {
  Report report(PADDLE_REPORT);
  paddle_reading(&firmware_, report.data(), us(now - start_));
  return {report};
}

void PaddleModel::on_output(ReportView report, Time now) {
  if (report.size() != 1 + PADDLE_REPORT || report[0] != 0 ||
      !paddle_command(&firmware_, report.data() + 1, us(now - start_))) {
    ++rejected_;
  }
}

std::optional<Report> PaddleModel::on_get_feature(std::uint8_t id) {
  if (id != 0) return std::nullopt;
  Report report(1 + PADDLE_REPORT);
  paddle_feature(&firmware_, report.data() + 1);
  return report;
}

}  // namespace limpid::test
