// Reports of a USB PID (physical interface device, force feedback) joystick of two axes: the report
// descriptor and the places of its fields. Layouts differ as products do; a host that reads the
// descriptor copes with all of them.
#pragma once

#include <optional>

#include "tests/support/hid/descriptor_writer.h"

namespace limpid::test {

struct PidLayout {
  // Usages of the effect types, in the order of the arrays that choose one.
  std::vector<std::uint8_t> effect_types = {0x26, 0x31, 0x40};  // constant, sine, spring
  std::uint8_t first_id = 1;                                    // of the output and feature reports
  int magnitude_max = 10000;                                    // 16 bits; below 128: 8 bits
  bool enables_axes = true;              // otherwise forces have a direction only
  int direction_max = 255;               // for a whole turn; above 255: 16 bits
  bool direction_in_hundredths = false;  // [0.01 degrees] without a unit; otherwise [degrees]
  bool physical_axes = true;             // the stick's axes tell their angle [mrad]
  bool control_in_report = false;        // device control inside a collection of its own
  bool control_in_bits = false;  // device control has one bit per command; otherwise numbers
  bool override_switch = true;   // among the device's states
  bool creates_effects = true;   // otherwise the host chooses the effects' indices

  // Layout of the standard's examples.
  static PidLayout standard() { return {}; }
  // A layout that differs in everything a host might take for granted.
  static PidLayout unusual();
};

struct PidReports {
  DescriptorWriter writer;
  // input
  Field x, y, buttons;
  Field paused, actuators, safety, power;  // states of the device, one bit each
  Field state_playing, state_index;
  // set effect, set constant force
  Field effect_index, effect_type, duration, gain, trigger_button;
  std::optional<Field> axes;
  Field direction_enable, direction;
  Field constant_index, magnitude;
  // other outputs
  std::uint8_t envelope_id = 0, condition_id = 0, periodic_id = 0;
  Field operation_index, operation, loops;
  Field free_index, control, device_gain;
  // features
  std::optional<Field> create_type;
  Field load_index, load_status, load_free;
  Field pool_size, pool_effects, pool_managed;
};

PidReports pid_reports(const PidLayout& layout);

}  // namespace limpid::test
