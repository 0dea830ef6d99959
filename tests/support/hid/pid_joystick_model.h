// A force-feedback joystick after the USB PID standard 1.0: two axes with motors, effects that end
// by themselves, springy hands. Of the effects only constant forces push.
//
// A positive magnitude pushes towards positive X or Y where axes are enabled one by one. With a
// direction, an angle clockwise from north (the far side, -Y), the force comes from there: 0 pushes
// towards +Y, 90 degrees towards -X.
#pragma once

#include <map>
#include <string>

#include "tests/support/hid/pid_layout.h"
#include "tests/support/hid/reference_device.h"
#include "tests/support/hid/sprung_hand.h"

namespace limpid::test {

// Firmwares of products, after their published sources. They read the same reports differently: in
// how an effect's angle and axis bits become a force, and in the states they report.
enum class PidFirmware {
  standard,
  arduino,       // the Arduino joystick library with force feedback
  fino,          //
  open_ffboard,  //
  adapt,         // adapt-ffb-joy, with a SideWinder Force Feedback Pro
};
std::string name(PidFirmware firmware);

struct PidJoystickOptions {
  PidFirmware firmware = PidFirmware::standard;
  HidIdentity identity{"Limpid PID joystick", 0x1209, 0x4C49, "PID-1"};
  PidLayout layout{};
  int capacity = 4;            // effects at a time, at most 40
  int first_block = 1;         // the lowest index of an effect
  bool fails_to_load = false;  // makes no effect and reports that
  double torque_limit = 1;     // of each axis, at full magnitude and gain [N m]
  AxisPhysics physics{};       // of both axes
  bool only_changes = false;   // sends nothing while nothing moves
  Time period = std::chrono::milliseconds(1);

  static PidJoystickOptions of(PidFirmware firmware);
};

struct PidEffect {
  std::uint8_t type = 0;     // usage of its type
  double magnitude = 0;      // -1 to 1
  double gain = 1;           // 0 to 1
  double x = 0, y = 0;       // direction of its force
  Time delay{}, duration{};  // duration 0: for ever
  bool parameters = false;   // "set effect" has been received
  bool playing = false;
  Time start{};
  int loops = 1;
};

class PidJoystickModel : public ReferenceDevice {
 public:
  // Whether it pushes a host that follows the standard the wrong way along X and Y.
  static constexpr std::array<bool, 2> kReversed{};
  static constexpr int kTorqueLevels = 10000;  // from none to full torque, at least

  explicit PidJoystickModel(const PidJoystickOptions& options = {});

  // Safety switch and power, for firmwares that report them.
  void let_go(bool off) { let_go_ = off; }
  void lose_power(bool off) { powerless_ = off; }
  SprungHand& hand() { return hand_; }
  const SprungHand& hand() const { return hand_; }
  void press(std::uint8_t buttons) { buttons_ = buttons; }
  static PidJoystickOptions usual_options() { return {}; }
  const std::map<int, PidEffect>& effects() const { return effects_; }
  bool actuators() const { return actuators_; }
  double device_gain() const { return device_gain_; }
  // Torque of the motors of axes X and Y at this moment [N m].
  Torque acting(Time now) const;

 private:
  void restart(Time now) override;
  void run(Time now) override;
  std::vector<Report> next_input(Time now) override;
  void on_output(ReportView report, Time now) override;
  std::optional<Report> on_get_feature(std::uint8_t id) override;
  bool on_set_feature(ReportView report, Time now) override;
  std::optional<Report> on_ask(std::uint8_t id) override;

  void set_effect(ReportView report);
  void set_constant(ReportView report);
  void operate(ReportView report, Time now);
  void control(ReportView report);
  void control(int what);
  void end_effects(Time now);
  std::pair<double, double> direction(ReportView report);
  std::pair<double, double> standard_direction(ReportView report);
  void say_state() { said_.push_back(state()); }
  // Returns the effect of this index; without one, notes a violation and returns nullptr.
  PidEffect* effect(std::int64_t index);
  bool complete(ReportView report, const Field& field, DescriptorWriter::Kind kind);
  std::int64_t allowed(ReportView report, const Field& field, const char* name);
  Report stick() const;
  Report state() const;

  PidJoystickModel(const PidJoystickOptions& options, PidReports reports);
  PidJoystickOptions options_;
  PidReports reports_;
  SprungHand hand_;
  std::map<int, PidEffect> effects_;
  bool actuators_ = false, paused_ = false;
  double device_gain_ = 1;
  std::uint8_t buttons_ = 0;
  bool let_go_ = false, powerless_ = false;
  int created_ = 0;  // index of the new effect; 0: the pool was full
  Report sent_stick_, sent_state_;
  std::vector<Report> said_;  // states that wait to be sent
};

// The same, with the firmware as its type, for typed tests.
template <PidFirmware kFirmware>
class PidJoystickOf final : public PidJoystickModel {
 public:
  static constexpr std::array<bool, 2> kReversed{kFirmware == PidFirmware::arduino,
                                                 kFirmware == PidFirmware::arduino};
  static constexpr int kTorqueLevels = kFirmware == PidFirmware::adapt ? 127 : 10000;
  explicit PidJoystickOf(const PidJoystickOptions& options = PidJoystickOptions::of(kFirmware))
      : PidJoystickModel(options) {}
  static PidJoystickOptions usual_options() { return PidJoystickOptions::of(kFirmware); }
};
using ArduinoJoystick = PidJoystickOf<PidFirmware::arduino>;
using FinoJoystick = PidJoystickOf<PidFirmware::fino>;
using OpenFfboardJoystick = PidJoystickOf<PidFirmware::open_ffboard>;
using AdaptJoystick = PidJoystickOf<PidFirmware::adapt>;

}  // namespace limpid::test
