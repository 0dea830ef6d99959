// Usages of the Physical Interface Device page (USB Device Class Definition for PID 1.0).
#pragma once

#include "devices/hid/report_descriptor.h"

namespace limpid::pid {

constexpr Usage pid_usage(std::uint16_t id) { return make_usage(0x0F, id); }

inline constexpr Usage kSetEffect = pid_usage(0x21);
inline constexpr Usage kBlockIndex = pid_usage(0x22);
inline constexpr Usage kEffectType = pid_usage(0x25);
inline constexpr Usage kTypeConstantForce = pid_usage(0x26);
inline constexpr Usage kDuration = pid_usage(0x50);
inline constexpr Usage kGain = pid_usage(0x52);
inline constexpr Usage kAxesEnable = pid_usage(0x55);
inline constexpr Usage kDirectionEnable = pid_usage(0x56);
inline constexpr Usage kDirection = pid_usage(0x57);

inline constexpr Usage kSetConstantForce = pid_usage(0x73);
inline constexpr Usage kMagnitude = pid_usage(0x70);

inline constexpr Usage kEffectOperation = pid_usage(0x77);
inline constexpr Usage kEffectStart = pid_usage(0x79);
inline constexpr Usage kEffectStop = pid_usage(0x7B);
inline constexpr Usage kLoopCount = pid_usage(0x7C);

inline constexpr Usage kDeviceGainReport = pid_usage(0x7D);
inline constexpr Usage kDeviceGain = pid_usage(0x7E);

inline constexpr Usage kBlockLoad = pid_usage(0x89);
inline constexpr Usage kLoadSuccess = pid_usage(0x8C);
inline constexpr Usage kLoadFull = pid_usage(0x8D);
inline constexpr Usage kLoadError = pid_usage(0x8E);
inline constexpr Usage kBlockFree = pid_usage(0x90);
inline constexpr Usage kCreateNewEffect = pid_usage(0xAB);

inline constexpr Usage kDeviceControl = pid_usage(0x96);
inline constexpr Usage kEnableActuators = pid_usage(0x97);
inline constexpr Usage kDisableActuators = pid_usage(0x98);
inline constexpr Usage kStopAllEffects = pid_usage(0x99);
inline constexpr Usage kDeviceReset = pid_usage(0x9A);
inline constexpr Usage kDeviceContinue = pid_usage(0x9C);

inline constexpr Usage kState = pid_usage(0x92);
inline constexpr Usage kDevicePaused = pid_usage(0x9F);
inline constexpr Usage kActuatorsEnabled = pid_usage(0xA0);
inline constexpr Usage kSafetySwitch = pid_usage(0xA4);
inline constexpr Usage kActuatorPower = pid_usage(0xA6);

}  // namespace limpid::pid
