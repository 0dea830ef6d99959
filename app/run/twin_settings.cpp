#include "app/run/twin_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace limpid {

bool own_of_twin(const ParameterInfo& info) {
  const std::string_view key = info.key;
  return std::ranges::any_of(
      std::array<std::string_view, 5>{"coupling.", "observer.", "predictor.", "ledger.", "model."},
      [key](std::string_view group) { return key.starts_with(group); });
}

void share_world(const Parameters& first, Parameters& twin) {
  for (const ParameterInfo& info : parameter_table()) {
    if (!own_of_twin(info)) set_parameter_number(twin, info, parameter_number(first, info));
  }
  twin.tick = first.tick;
}

std::array<std::string, 2> twin_names(const Parameters& first, const Parameters& twin) {
  if (first.kind != twin.kind) return {name(first.kind), name(twin.kind)};
  for (const ParameterInfo& info : parameter_table()) {
    const std::string a = parameter_text(first, info), b = parameter_text(twin, info);
    if (a == b) continue;
    const auto called = [&info](const std::string& text) {
      return fmt::format("{} {}", info.label, text.empty() ? "default" : text);
    };
    return {called(a), called(b)};
  }
  return {std::string(name(first.kind)) + " 1", std::string(name(twin.kind)) + " 2"};
}

}  // namespace limpid
