#include "app/desktop/base/window_layout.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string_view>

#include "app/desktop/base/plot_toml.h"
#include "devices/files/config_file.h"
#include "devices/files/toml_reader.h"

namespace limpid {
namespace {

constexpr double kLeastPanel = 100, kMostPanel = 1000;  // [px at scale 1]

// Every setting of a layout but its plots, once, for reading and writing.
template <class S, class Visit>
void each_of_layout(S& s, Visit&& visit) {
  visit("show_left", s.show_left);
  visit("show_right", s.show_right);
  visit("show_plots", s.show_plots);
  visit("left", s.left);
  visit("right", s.right);
  visit("plots", s.plots);
}

void read_layout(const TomlTable& table, const char* key, bool& value) {
  const toml::node* node = table.find(key);
  if (node == nullptr) return;
  if (!node->is_boolean()) table.refuse(key, "true, false");
  value = *node->value<bool>();
}

void read_layout(const TomlTable& table, const char* key, double& value) {
  value = table.number(key, {kLeastPanel, kMostPanel}).value_or(value);
}

bool of_preset(const ParameterInfo& info) {
  const std::string_view key = info.key;
  return std::ranges::any_of(std::array<std::string_view, 3>{"coupling.", "observer.", "ledger."},
                             [key](std::string_view group) { return key.starts_with(group); });
}

}  // namespace

std::string layout_text(const Settings& settings) {
  toml::table table;
  each_of_layout(settings, [&](const char* key, const auto& value) { table.insert(key, value); });
  table.insert("plot", plots_toml(settings.plot_choices));
  std::ostringstream text;
  text << toml::toml_formatter(table);
  return text.str();
}

void apply_layout(Settings& settings, const std::string& text, const std::string& where) {
  const toml::table table = parse_toml(text, where);
  Settings changed = settings;
  const TomlTable whole(table, where, "");
  each_of_layout(changed, [&](const char* key, auto& value) { read_layout(whole, key, value); });
  changed.plot_choices = plots_of(table, where);
  settings = std::move(changed);
}

std::string preset_text(const Parameters& p) {
  std::string text;
  for (const ParameterInfo& info : parameter_table()) {
    const std::string value = parameter_text(p, info);
    if (of_preset(info) && !value.empty()) text += fmt::format("{} = {}\n", info.key, value);
  }
  return text;
}

void apply_preset(Parameters& p, const std::string& text, const std::string& where) {
  Parameters changed = p;
  const Parameters paper;
  for (const ParameterInfo& info : parameter_table()) {
    if (of_preset(info)) set_parameter_number(changed, info, parameter_number(paper, info));
  }
  apply_config_text(changed, text, where);
  p = changed;
}

}  // namespace limpid
