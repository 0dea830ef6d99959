// The arm that a device is taken for. Its ranges, levers and inertia limit the motors' force, so it
// must be known: from the device itself, from an identification, or from a person. The arm that
// happens to be open is never used.
#pragma once

#include <string>

#include "app/device/device_store.h"
#include "core/dynamics/arm_description.h"
#include "devices/files/text_file.h"
#include "devices/hid/protocols.h"

namespace limpid {

// Thrown if no arm is known for a device, and no built-in one has as many joints.
struct UnknownArmError : FileError {
  using FileError::FileError;
};

struct TakenArm {
  ArmDescription arm;  // ranges and torques are within the device's own
  std::string why;     // reason for this arm, in sentences for people
  bool known = false;  // else a provisional built-in one, with less torque
};

// The arm within the limits of the device: the narrower range of each joint, the lower torque.
// Errors: FileError if the numbers of joints differ, or ranges do not overlap.
ArmDescription narrowed(ArmDescription arm, const DeviceTraits& traits);

inline constexpr double kShortestLever = 0.05;  // of an unknown device [m]

// The identified arm, else the device's own, else `named` (by the running command; null: none),
// else a person's choice, else a built-in one. A known arm that no longer fits the device is
// reported and not used. Torques of a built-in one are held to the tip's limit at kShortestLever,
// as its real levers are unknown. `kind` null: nothing is plugged in. Errors: FileError if an arm's
// file cannot be read; UnknownArmError.
TakenArm taken_arm(const DeviceNotes& notes, const DeviceKind* kind, const DeviceTraits& traits,
                   const ArmDescription* named = nullptr);

// The arm before the device is connected, as far as the notes tell: "its built-in arm, as was
// said".
std::string arm_words(const DeviceNotes& notes, const DeviceKind& kind);

// Whether a person may choose the arm: the device does not tell it, was not identified, and has an
// arm.
bool may_be_told_its_arm(const DeviceNotes& notes, const DeviceKind& kind);

}  // namespace limpid
