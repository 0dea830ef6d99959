#include "app/run/lane_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace limpid {
namespace {

// Returns the first setting in which some of these lanes differ; null: they are all alike.
const ParameterInfo* first_difference(const std::vector<const Parameters*>& lanes) {
  for (const ParameterInfo& info : parameter_table()) {
    const std::string text = parameter_text(*lanes.front(), info);
    const auto other = [&](const Parameters* p) { return parameter_text(*p, info) != text; };
    if (std::ranges::any_of(lanes, other)) return &info;
  }
  return nullptr;
}

}  // namespace

std::vector<const ParameterInfo*> differing(const Parameters& one, const Parameters& other) {
  std::vector<const ParameterInfo*> all;
  for (const ParameterInfo& info : parameter_table()) {
    if (parameter_text(one, info) != parameter_text(other, info)) all.push_back(&info);
  }
  return all;
}

void share_world(std::span<Parameters> lanes) {
  for (Parameters& other : lanes.subspan(1)) {
    const ControllerSettings own = other;
    other = lanes.front();
    static_cast<ControllerSettings&>(other) = own;
  }
}

void check_of_one_lane(std::string_view key, const std::string& instead) {
  const ParameterInfo* info = find_parameter(key);
  if (info == nullptr || of_controller(*info)) return;
  throw ParameterError(fmt::format("{}: is one setting for all runs; {}", key, instead));
}

CouplingKind law_beside(std::span<const Parameters> lanes) {
  using enum CouplingKind;
  for (const CouplingKind kind : {standard, predictive, proposed}) {
    if (std::ranges::find(lanes, kind, &Parameters::kind) == lanes.end()) return kind;
  }
  return lanes.front().kind;
}

std::vector<std::string> lane_names(std::span<const Parameters> lanes) {
  std::vector<std::string> names;
  for (const Parameters& p : lanes) {
    std::vector<const Parameters*> alike;  // lanes of the same law
    for (const Parameters& other : lanes) {
      if (other.kind == p.kind) alike.push_back(&other);
    }
    const std::string law = name(p.kind);
    if (alike.size() == 1) {
      names.push_back(law);
    } else if (const ParameterInfo* info = first_difference(alike)) {
      const std::string text = parameter_text(p, *info);
      names.push_back(fmt::format("{}{} {}", alike.size() < lanes.size() ? law + ", " : "",
                                  info->label, text.empty() ? "default" : text));
    } else {
      names.push_back(law);
    }
  }
  // A number tells apart what is still alike.
  const std::vector<std::string> before = names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::ranges::count(before, before[i]) > 1) names[i] += fmt::format(" {}", i + 1);
  }
  return names;
}

}  // namespace limpid
