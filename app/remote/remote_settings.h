// Settings in JSON, and the limits that programs on the control socket cannot raise.
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
// Sets all "values" of a request, which must be there, in the settings of a lane; a lane beside the
// first has none that all lanes share. Errors: as set_by_remote().
void set_values(Parameters& p, const Keys& keys, std::size_t lane, const Parameters& highest);

// Settings in which limits left to the arm are numbers.
Parameters with_limits_of(const ArmDescription& arm, Parameters p);
// Lowers limits of settings from a file to those that a person has chosen for the arm.
void hold_limits(Parameters& p, const Parameters& chosen, const ArmDescription& arm);
// Usual settings for the arm, with limits no higher than a person has chosen. Settings fixed while
// a loop runs stay as in `now`; with a real device also its own: its encoders, and what its motors
// take off the hand.
Parameters usual_settings(const Parameters& now, const Parameters& chosen,
                          const ArmDescription& arm, bool with_device);
// A field's value in JSON; null if it is left open: to the arm, or to another setting.
nlohmann::json json_of(const std::optional<FieldValue>& value);
// Inverse of json_of(). Errors: RemoteError for a value of no kind that a field has.
FieldValue field_value(const std::string& key, const nlohmann::json& value);

}  // namespace limpid
