#include "app/sweep/sweep_draft.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "app/run/fitted_gains.h"

namespace limpid {
namespace {

toml::array texts_of(const std::vector<std::string>& texts) {
  toml::array array;
  for (const std::string& text : texts) array.push_back(text);
  return array;
}

bool varies(const SweepDraft& draft, const std::string& key) {
  return std::ranges::find(draft.axes, key, &DraftAxis::key) != draft.axes.end();
}

toml::array settings_of(const SweepDraft& draft) {
  toml::array settings;
  for (const ParameterInfo& info : parameter_table()) {
    const std::string value = parameter_text(draft.parameters, info);
    // A sweep fits these to another arm where its plan does not say them.
    const bool fits =
        !draft.device.empty() &&
        std::ranges::find(kFittedKeys, std::string_view(info.key)) != kFittedKeys.end();
    if (value.empty() || (!fits && value == parameter_text(Parameters{}, info))) continue;
    if (varies(draft, info.key)) continue;
    settings.push_back(fmt::format("{} = {}", info.key, value));
  }
  return settings;
}

toml::table table_of(const DraftAxis& axis) {
  toml::table table{{"key", axis.key}};
  if (!axis.words.empty()) {
    table.insert("values", texts_of(axis.words));
    return table;
  }
  table.insert("from", axis.from);
  table.insert("to", axis.to);
  table.insert("count", static_cast<std::int64_t>(axis.count));
  if (axis.logarithmic) table.insert("scale", "log");
  return table;
}

}  // namespace

std::string short_name(const SweepDraft& draft) {
  std::string name = draft.measures.empty() ? "sweep" : draft.measures.front();
  for (const DraftAxis& axis : draft.axes) {
    name += (&axis == draft.axes.data() ? " over " : " and ") +
            axis.key.substr(axis.key.rfind('.') + 1);
  }
  return name;
}

std::string plan_text(const SweepDraft& draft) {
  toml::table plan{{"title", draft.title}};
  if (!draft.device.empty()) plan.insert("device", draft.device);
  if (draft.hand.empty()) {
    plan.insert("hand", toml::table{{"tap", draft.tap}});
  } else {
    plan.insert("hand", draft.hand);
    if (!draft.scene.empty()) plan.insert("scene", draft.scene);
  }
  if (draft.seconds > 0) plan.insert("seconds", draft.seconds);
  if (toml::array settings = settings_of(draft); !settings.empty()) {
    plan.insert("set", std::move(settings));
  }
  plan.insert("measure", texts_of(draft.measures));
  toml::array axes;
  for (const DraftAxis& axis : draft.axes) axes.push_back(table_of(axis));
  plan.insert("axis", std::move(axes));
  // The line of theory is the proposed law's.
  if (varies(draft, "coupling.eta") && !varies(draft, "coupling.kind") &&
      draft.parameters.kind == CouplingKind::proposed) {
    plan.insert("figure", toml::table{{"theory", toml::array{"pr"}}});
  }
  std::ostringstream text;
  text << plan << '\n';
  return text.str();
}

}  // namespace limpid
