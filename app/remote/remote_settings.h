// Settings as JSON has them, and what programs on the control socket may not set.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "app/remote/protocol.h"
#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"

namespace limpid {

inline constexpr std::size_t kMostSettings = 200;  // that one request names

// Sets `key` of `p` to a value. Those of kMotorLimits are at most as they are in
// `highest`, which is what a person has chosen; what is fixed while a loop runs stays. Errors,
// after which `p` is as it was: RemoteError, ParameterError.
void set_by_remote(Parameters& p, const std::string& key, const nlohmann::json& value,
                   const Parameters& highest);
// The same of all `values` of a request, which are needed. Errors: the same.
void set_values(Parameters& p, const Keys& keys, const Parameters& highest);

// The settings with what they leave to the arm said in numbers, where it is a limit.
Parameters with_limits_of(const ArmDescription& arm, Parameters p);
// Settings that come from a file, with limits no higher than a person has chosen for the arm.
void hold_limits(Parameters& p, const Parameters& chosen, const ArmDescription& arm);
// The settings that are usual for the arm, with limits no higher than a person has chosen. What is
// fixed while a loop runs stays as it is `now`; with a real device in the arm's place, so does what
// is the device's own: its encoders, and what its motors take off the hand.
Parameters usual_settings(const Parameters& now, const Parameters& chosen,
                          const ArmDescription& arm, bool with_device);
// The value that a setting has; null where it is left to the arm, or to another setting.
nlohmann::json value_of(const Parameters& p, const ParameterInfo& info);

}  // namespace limpid
