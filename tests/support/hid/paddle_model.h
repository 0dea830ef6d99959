// The paddle of assets/paddle: its firmware as it is flashed, a motor, an encoder, and a springy
// hand.
#pragma once

#include "paddle.h"
#include "tests/support/hid/reference_device.h"
#include "tests/support/hid/sprung_hand.h"

namespace limpid::test {

class PaddleModel final : public ReferenceDevice {
 public:
  explicit PaddleModel(const AxisPhysics& physics = paddle_axis());

  // Physics of the paddle as in assets/devices/paddle.urdf.
  static AxisPhysics paddle_axis();

  SprungHand& hand() { return hand_; }
  Paddle& firmware() { return firmware_; }
  void set_driver_fault(bool fault) { driver_fault_ = fault; }
  void lay_at_its_end() { at_end_ = true; }  // as a person does after switching it on
  void swap_the_motors_wires() { swapped_ = true; }
  void skip_steps(int steps) { skipping_ = steps; }
  // Freezes encoder lines: bit 0 for line A, bit 1 for line B.
  void break_lines(std::uint8_t lines) { broken_ = lines; }
  int rejected() const { return rejected_; }

 private:
  void restart(Time now) override;
  void run(Time now) override;
  std::vector<Report> next_input(Time now) override;
  void on_output(ReportView report, Time now) override;
  std::optional<Report> on_get_feature(std::uint8_t id) override;
  bool on_set_feature(ReportView, Time) override { return false; }

  void turn_encoder();
  void see(std::uint8_t pins);

  SprungHand hand_;
  Paddle firmware_{};
  Time start_{};
  long count_ = 0;  // encoder steps without faults
  int skipping_ = 0, rejected_ = 0;
  std::uint8_t broken_ = 0;
  bool at_end_ = false, driver_fault_ = false, swapped_ = false;
};

}  // namespace limpid::test
