// Models of every device that the loop is tried with: joysticks of four firmwares and a raw arm.
#pragma once

#include <gtest/gtest.h>

#include "tests/support/hid/pid_joystick_model.h"
#include "tests/support/hid/raw_device_model.h"

namespace limpid::test {

using Models = testing::Types<ArduinoJoystick, FinoJoystick, OpenFfboardJoystick, AdaptJoystick,
                              RawDeviceModel>;

template <class Model>
inline constexpr const char* kName = "?";
template <>
inline constexpr const char* kName<ArduinoJoystick> = "arduino";
template <>
inline constexpr const char* kName<FinoJoystick> = "fino";
template <>
inline constexpr const char* kName<OpenFfboardJoystick> = "open_ffboard";
template <>
inline constexpr const char* kName<AdaptJoystick> = "adapt";
template <>
inline constexpr const char* kName<RawDeviceModel> = "raw";

}  // namespace limpid::test
