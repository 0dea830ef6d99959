// Card of the device in use: its way into the hand, step by step, and what each step needs.
#pragma once

#include <string>

#include "app/desktop/device/device_controller.h"

namespace limpid {

// Label of the button that begins the check of a device's axes.
inline constexpr const char* kCheckAxes = "Check the axes";

// Labels of the buttons that say which arm a device is.
inline constexpr const char* kBuiltInArmButton = "the built-in one";
inline constexpr const char* kOpenArmButton = "the open one";
inline constexpr const char* kArmOfFileButton = "a file...";

// State of a step: it is done, is the one to do now, has failed, or waits for the ones before.
enum class StepState : std::uint8_t { done, now, failed, later };

// States of all steps. What waits has nothing to press.
struct DeviceSteps {
  StepState found = StepState::now, arm = StepState::later, axes = StepState::later,
            measured = StepState::later, force = StepState::later;
};
// Knowledge of the device in use.
struct DeviceSituation {
  bool present = false;  // it is plugged in and may be opened
  bool asks_for_arm = false;
  bool checking = false, check_failed = false, awaits_check = false;
  bool in_place = false;  // it drives the loop
  bool measured = false;  // by an identification
  bool pushes = false;    // its force is on, or fades in
  bool problem = false;   // there is something to say
};
DeviceSteps steps_of(const DeviceSituation& of);

// Requests made on the card.
struct DeviceCardAsks {
  bool identify = false;
  bool arm_file = false;  // asks for the file of the device's arm
};
// Draws the card into the open window; `p` are the loop's settings, for the delay they reckon with.
DeviceCardAsks draw_device_card(DeviceController& devices, const LiveStage& live, Parameters& p);

// Returns the parameters with the predictive law's delay set to a measured one [s], in whole ticks
// up to its limit.
Parameters reckoning_with(Parameters p, double delay);

}  // namespace limpid
