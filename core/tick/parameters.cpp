#include "core/tick/parameters.h"

#include <algorithm>
#include <cmath>

namespace limpid {
namespace {

using P = Parameters;

constexpr auto kController = ControllerSettings::settings<P>();
constexpr auto kTable =
    joined(kController, LoopSettings::settings<P>(), HandSettings::settings<P>(),
           DeviceSettings::settings<P>(), PlantSettings::settings<P>());

}  // namespace

int most_delay(const Parameters& p, std::optional<double> identified, bool real) {
  constexpr double kUsual = 3;  // for a device of unknown delay [ticks]
  double most = p.delay_most;
  if (std::isnan(most) && !real) most = p.device_delay;
  if (std::isnan(most)) most = identified ? *identified / p.tick + 1 : kUsual;
  return std::clamp(static_cast<int>(std::ceil(most)), p.delay, kMostDelay);
}

std::span<const ParameterInfo> parameter_table() { return kTable; }

const ParameterInfo* find_parameter(std::string_view key) { return find_field(kTable, key); }

bool of_controller(const ParameterInfo& info) {
  return find_field(kController, info.key) != nullptr;
}

void set_parameter(Parameters& p, std::string_view key, const ParameterValue& value) {
  const ParameterInfo* info = find_parameter(key);
  if (info == nullptr) {
    throw ParameterError(std::string(key) + ": no such key; `limpid run --help` lists them");
  }
  set_value(*info, p, value);
}

std::string parameter_text(const Parameters& p, const ParameterInfo& info) {
  const std::optional<FieldValue> value = value_of(info, p);
  if (!value) return {};
  const std::string text = field_text(*value);
  // A number without a point would be an integer to TOML.
  const bool whole = text.find_first_of(".e") == std::string::npos;
  return info.kind == FieldInfo::Kind::number && whole ? text + ".0" : text;
}

bool operator==(const Parameters& a, const Parameters& b) {
  return std::ranges::all_of(kTable, [&](const ParameterInfo& info) {
    const double x = number_of(info, a), y = number_of(info, b);
    // Values left to the arm are NaN, and count as equal.
    return x == y || (std::isnan(x) && std::isnan(y));
  });
}

}  // namespace limpid
