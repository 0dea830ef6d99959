#include "app/remote/remote_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "app/run/lane_settings.h"
#include "core/base/lanes.h"

namespace limpid {
namespace {

using nlohmann::json;

bool is_vector(const json& value) {
  return value.is_array() && value.size() == 3 &&
         std::ranges::all_of(value, [](const json& each) { return each.is_number(); });
}

}  // namespace

FieldValue field_value(const std::string& key, const json& value) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_unsigned() && value.get<std::uint64_t>() > std::uint64_t{1} << 53) {
    return value.get<double>();
  }
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number()) return value.get<double>();
  if (value.is_string()) return value.get<std::string>();
  if (is_vector(value)) return Vec3(value[0], value[1], value[2]);
  throw RemoteError(fmt::format(
      "set: {}: {} is not allowed; allowed: a number, a text, true or false", key, shown(value)));
}

json json_of(const std::optional<FieldValue>& value) {
  if (!value) return nullptr;
  return std::visit(
      []<class T>(const T& x) -> json {
        if constexpr (std::is_same_v<T, Vec3>) {
          return {x[0], x[1], x[2]};
        } else if constexpr (std::is_same_v<T, double>) {
          return std::isfinite(x) ? json(x) : json();
        } else {
          return x;
        }
      },
      *value);
}

void set_by_remote(Parameters& p, const std::string& key, const json& value,
                   const Parameters& highest) {
  const Parameters before = p;
  set_parameter(p, key, field_value(key, value));
  const ParameterInfo& info = *find_parameter(key);
  if (!info.live && parameter_text(before, info) != parameter_text(p, info)) {
    p = before;
    throw RemoteError(fmt::format(
        "set: {}: cannot change while the loop runs; choose this setting when the program starts",
        key));
  }
  if (std::ranges::count(kMotorLimits, key) == 0) return;
  const double asked = parameter_number(p, info);
  const double most = parameter_number(highest, info);
  const double now = parameter_number(before, info);
  if (asked == now || asked <= most) return;
  p = before;
  throw RemoteError(fmt::format(
      "set: {}: {} is not allowed; allowed: up to {} {}. Only a person raises a limit, in the "
      "window or when the program starts",
      key, shown(value), most, info.unit));
}

void set_values(Parameters& p, const Keys& keys, std::size_t lane, const Parameters& highest) {
  const json& values = keys.of("values");
  if (!values.is_object() || values.size() > kMostSettings) {
    throw keys.error("values",
                     shown(values) + " is not allowed; allowed: a JSON object with settings");
  }
  Parameters all = p;
  for (const auto& [key, value] : values.items()) {
    if (lane != kMainLane) check_of_one_lane(key, "set it for the first run");
    set_by_remote(all, key, value, highest);
  }
  p = all;
}

Parameters with_limits_of(const ArmDescription& arm, Parameters p) {
  if (!std::isnan(p.torque_limit)) return p;
  p.torque_limit = std::ranges::min(arm.joints, {}, &Joint::effort).effort;
  return p;
}

void hold_limits(Parameters& p, const Parameters& chosen, const ArmDescription& arm) {
  const Parameters most = with_limits_of(arm, chosen);
  for (const char* key : kMotorLimits) {
    const ParameterInfo& info = *find_parameter(key);
    if (parameter_number(p, info) <= parameter_number(most, info)) continue;
    set_parameter_number(p, info, parameter_number(chosen, info));
  }
}

}  // namespace limpid
