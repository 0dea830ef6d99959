// An arm that speaks the open raw-HID protocol, version 1: up to six joints with motors, encoders,
// a watchdog of its own and springy hands.
#pragma once

#include <deque>

#include "tests/support/hid/reference_device.h"
#include "tests/support/hid/sprung_hand.h"

namespace limpid::test {

struct RawDeviceLayout {
  HidIdentity identity{"Limpid raw arm", 0x1209, 0x4C50, "RAW-1"};
  int joints = 3;  // 1 to 6
  bool pushes = true;
  Time watchdog = std::chrono::milliseconds(10);
  Time period = std::chrono::milliseconds(1);
  double resolution = 1e-4;   // of the encoders [rad]; 0: that of a float
  double torque_limit = 1.5;  // [N m]
  Time lag{};                 // from a command's arrival to its torque
  AxisPhysics physics{};      // of each joint; paths may be set later
};

class RawDeviceModel : public ReferenceDevice {
 public:
  explicit RawDeviceModel(const RawDeviceLayout& layout = {});

  SprungHand& hand() { return hand_; }
  const SprungHand& hand() const { return hand_; }
  void set_motors(bool powered, Time now);
  void set_unwell(bool unwell) { unwell_ = unwell; }  // the fault bit of its status
  void set_calibrated(bool calibrated) { calibrated_ = calibrated; }
  int commands() const { return commands_; }  // good commands received
  int rejected() const { return rejected_; }  // bad commands received
  int gaps() const { return gaps_; }          // commands that were lost on the way
  // Whether its own watchdog has cut the torque; the next good command ends that.
  bool cut() const { return cut_; }

 private:
  void restart(Time now) override;
  void run(Time now) override;
  std::vector<Report> next_input(Time now) override;
  void on_output(ReportView report, Time now) override;
  std::optional<Report> on_get_feature(std::uint8_t id) override;
  bool on_set_feature(ReportView, Time) override { return false; }

  bool well_formed(ReportView message) const;
  void check_manners(ReportView message);
  bool follows(ReportView message) const;
  void act(const Torque& torque, Time now, ForceCause cause);

  RawDeviceLayout layout_;
  SprungHand hand_;
  bool motors_ = true, unwell_ = false, calibrated_ = true, cut_ = false, addressed_ = false;
  int commands_ = 0, rejected_ = 0, gaps_ = 0;
  std::deque<std::pair<Time, Torque>> late_;  // commands that do not act yet
  Torque torque_{};
  Time start_{}, fed_{};
  std::uint32_t sequence_ = 0;  // of its newest report
  std::uint64_t stamp_ = 0;     // of its newest report [us]
  std::uint32_t command_ = 0;   // sequence of the newest command
};

}  // namespace limpid::test
