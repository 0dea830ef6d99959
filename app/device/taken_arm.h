// Which arm a device is taken for. Ranges, levers and inertia of that arm bound what its motors may
// do, so it never follows from what is open by chance: the device says it itself, it was
// identified, or somebody has said it.
#pragma once

#include <string>

#include "app/device/device_store.h"
#include "core/dynamics/arm_description.h"
#include "devices/files/text_file.h"
#include "devices/hid/protocols.h"

namespace limpid {

// No arm is known for it, and no built-in one has as many joints.
struct UnknownArmError : FileError {
  using FileError::FileError;
};

struct TakenArm {
  ArmDescription arm;  // its ranges and torques are within the device's own
  std::string why;     // which it is, and by what it is known: sentences for people
  bool known = false;  // else it is a built-in one for now, with less torque
};

// The arm within what the device declares: the narrower range of each joint, the lower torque.
// Errors: FileError, where the joints are not as many, or a joint's ranges have nothing in common.
ArmDescription narrowed(ArmDescription arm, const DeviceTraits& traits);

inline constexpr double kShortestLever = 0.05;  // of a device that nothing is known of [m]

// The arm that it was identified as, else its own, else `named` (by the command that is carried
// out; null: none is), else what somebody has said, else a built-in one. What is known but does not
// fit the device any more is said, and not used. As nobody knows how long the levers of a device
// are of which nothing is known, its torque is held to the tip's limit at kShortestLever.
// `kind` null: nothing is plugged in. Errors: FileError, where an arm's file cannot be read;
// UnknownArmError.
TakenArm taken_arm(const DeviceNotes& notes, const DeviceKind* kind, const DeviceTraits& traits,
                   const ArmDescription* named = nullptr);

// The same before it is connected to, as far as the notes tell: "its built-in arm, as was said".
std::string arm_words(const DeviceNotes& notes, const DeviceKind& kind);

// Whether somebody may say which arm it is: it does not say so itself, was not identified, and has
// an arm at all.
bool may_be_told_its_arm(const DeviceNotes& notes, const DeviceKind& kind);

}  // namespace limpid
