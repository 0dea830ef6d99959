// A 3Dconnexion SpaceMouse: how far its cap is pushed and turned, and two buttons. No motors.
#pragma once

#include <functional>

#include "tests/support/hid/reference_device.h"

namespace limpid::test {

struct SpaceMouseLayout {
  HidIdentity identity{"3Dconnexion SpaceMouse Compact", 0x256F, 0xC635, "SM-1"};
  bool joined = false;          // all six axes in one report, as newer ones; else two of three
  bool silent_at_rest = false;  // like real ones: only one last report of zeros
  Time period = std::chrono::milliseconds(1);
};

class SpaceMouseModel : public ReferenceDevice {
 public:
  static constexpr int kFullScale = 350;
  using Cap = std::array<double, 6>;  // X, Y, Z, Rx, Ry, Rz, each -1 to 1

  explicit SpaceMouseModel(const SpaceMouseLayout& layout = {});

  // Leads the cap along `path`, by the time since it was plugged in [s].
  void move(std::function<Cap(double)> path) { path_ = std::move(path); }
  void press(std::uint16_t buttons) { buttons_ = buttons; }  // one bit for each button

 private:
  void restart(Time now) override;
  void run(Time) override {}
  std::vector<Report> next_input(Time now) override;
  void on_output(ReportView report, Time now) override;
  std::optional<Report> on_get_feature(std::uint8_t) override { return std::nullopt; }
  bool on_set_feature(ReportView, Time) override { return false; }

  SpaceMouseLayout layout_;
  std::function<Cap(double)> path_ = [](double) { return Cap{}; };
  std::uint16_t buttons_ = 0, sent_buttons_ = 0;
  bool resting_ = true;
  Time start_{};
};

}  // namespace limpid::test
