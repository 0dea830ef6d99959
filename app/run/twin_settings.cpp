#include "app/run/twin_settings.h"

#include <fmt/format.h>

namespace limpid {

void share_world(const Parameters& first, Parameters& twin) {
  const Parameters before = twin;
  const ControllerSettings& own = before;
  twin = first;
  static_cast<ControllerSettings&>(twin) = own;
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
