#include "app/story/story_settings.h"

#include <fmt/format.h>

#include <cmath>

#include "app/run/twin_settings.h"
#include "devices/files/config/config_file.h"
#include "devices/files/file_error.h"

namespace limpid {
namespace {

constexpr std::size_t kBoth = 2;

// A list of "key = value".
std::vector<std::pair<std::string, std::uint32_t>> settings_in(const TomlTable& step,
                                                               const char* key) {
  std::vector<std::pair<std::string, std::uint32_t>> all;
  const toml::node* node = step.find(key);
  if (node == nullptr) return all;
  const char* allowed = "a list of settings, as [\"coupling.eta = 0.6\", ...]";
  const toml::array* list = node->as_array();
  if (list == nullptr) step.refuse(key, allowed);
  for (const toml::node& each : *list) {
    if (!each.is_string()) step.refuse(key, allowed);
    all.emplace_back(*each.value<std::string>(), each.source().begin.line);
  }
  return all;
}

const ParameterInfo* key_of(const std::string& setting) {
  const std::string key = setting.substr(0, setting.find_first_of(" \t="));
  return find_parameter(key);
}

void check(const std::string& setting, std::size_t lane, double time) {
  const ParameterInfo* info = key_of(setting);
  if (info == nullptr) return;  // apply_setting says it better
  if (lane != kBoth && !own_of_twin(*info)) {
    throw ParameterError(fmt::format("{}: is one for both runs; it belongs under set", info->key));
  }
  if (!info->live && time > 0) {
    throw ParameterError(fmt::format("{}: may be set in the first step only", info->key));
  }
}

}  // namespace

void StorySettings::read(const TomlTable& step, const std::string& where, double time) {
  const std::array<Parameters, 2> before = now_;
  for (const auto& [key, lane] :
       {std::pair{"set", kBoth}, {"first", kMainLane}, {"twin", kTwinLane}}) {
    for (const auto& [setting, line] : settings_in(step, key)) {
      try {
        check(setting, lane, time);
        if (lane != kTwinLane) apply_setting(now_[kMainLane], setting);
        if (lane != kMainLane) apply_setting(now_[kTwinLane], setting);
      } catch (const ParameterError& error) {
        throw FileError(fmt::format("{}:{}: step.{}: {}", where, line, key, error.what()));
      }
    }
  }
  if (time == 0) {
    began_ = now_;
    return;
  }
  for (std::size_t lane = 0; lane < now_.size(); ++lane) {
    for (const ParameterInfo& info : parameter_table()) {
      const std::string value = parameter_text(now_[lane], info);
      if (value == parameter_text(before[lane], info)) continue;
      changes_[lane].push_back({time, fmt::format("{} = {}", info.key, value)});
    }
  }
}

void StorySettings::into(RunPlan& plan) const {
  const auto rows = [&](std::size_t lane) {
    std::vector<SettingChange> changes;
    for (const Change& change : changes_[lane]) {
      const auto row = std::llround(change.time / began_[kMainLane].tick);
      changes.push_back({static_cast<std::uint64_t>(row), change.setting});
    }
    return changes;
  };
  plan.parameters = began_[kMainLane];
  plan.changes = rows(kMainLane);
  plan.twin = TwinPlan{began_[kTwinLane], rows(kTwinLane), {}};
}

}  // namespace limpid
