#include "app/library/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/base/folders.h"
#include "app/run/fitted_gains.h"
#include "app/run/own_world.h"
#include "app/run/run_notes.h"
#include "app/run/scene_meshes.h"
#include "app/run/shipped_files.h"
#include "devices/files/config_file.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/session/session_units.h"
#include "devices/files/toml_reader.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// Returns the file of that name, or the one of that name that came along.
fs::path file_of(const std::string& name, const char* kind) {
  std::error_code unknown;
  if (fs::exists(name, unknown)) return name;
  if (const auto own = shipped_file(name, {kind})) return *own;
  throw FileError(name + ": no such file" + shipped_hint(name, {kind}));
}

void refuse_both(const std::string& file, const std::string& text, const char* what) {
  if (file.empty() || text.empty()) return;
  throw FileError(fmt::format("{} and {}_text: are both given; needed: one of them", what, what));
}

ArmDescription read_arm(const LoopOptions& options) {
  refuse_both(options.arm, options.arm_text, "arm");
  if (!options.arm_text.empty()) {
    return parse_urdf(options.arm_text, "arm_text", fs::current_path(), options.tip);
  }
  const fs::path file = options.arm.empty() ? default_device() : file_of(options.arm, "devices");
  return read_urdf(file, options.tip);
}

SceneDocument read_scene_of(const LoopOptions& options, const ArmDescription& arm) {
  refuse_both(options.scene, options.scene_text, "scene");
  if (!options.scene_text.empty()) {
    return parse_scene(options.scene_text, "scene_text", fs::current_path(), arm);
  }
  if (!options.scene.empty()) return read_scene(file_of(options.scene, "scenes"), arm);
  const bool built_in = options.arm.empty() && options.arm_text.empty() && options.tip.empty();
  return read_scene(built_in ? default_scene() : default_scene(arm), arm);
}

Parameters chosen(const LoopOptions& options, Parameters base) {
  if (!options.config.empty()) {
    const double before = std::exchange(base.tick, kFromArm);
    apply_config(base, options.config);
    if (!std::isnan(base.tick) && base.tick != options.period) {
      throw FieldError(fmt::format("{}: loop.tick: {} s differs from the option `period`, {} s",
                                   options.config, base.tick, options.period));
    }
    base.tick = before;
  }
  for (const std::string& setting : options.settings) {
    setting_named(key_of_setting(setting));
    apply_setting(base, setting);
  }
  if (base.tick != Parameters{}.tick && base.tick != options.period) {
    throw FieldError(fmt::format("loop.tick: {} s differs from the option `period`, {} s",
                                 base.tick, options.period));
  }
  const ParameterInfo& tick = setting_named("loop.tick");
  if (!(options.period >= tick.minimum && options.period <= tick.maximum)) {
    throw FieldError(fmt::format("period: {} s is not allowed; allowed: {} to {} s", options.period,
                                 tick.minimum, tick.maximum));
  }
  set_parameter(base, "loop.tick", options.period);
  return base;
}

// Refuses settings of a simulation that this loop does not have: they would do nothing.
void refuse_simulated(std::string_view key, LoopArm of) {
  if (of == LoopArm::own) return;
  constexpr std::array kOwn{"device.substeps", "device.gravity", "device.springs"};
  const bool of_arm = key.starts_with("plant.") || std::ranges::find(kOwn, key) != kOwn.end();
  if (of_arm || key.starts_with("hand.")) {
    throw FieldError(
        fmt::format("{}: belongs to the simulated {}, which a DeviceLoop does not have", key,
                    of_arm ? "arm" : "hand"));
  }
  if (of != LoopArm::real) return;
  if (key == "device.delay") {
    throw FieldError(
        "device.delay: delays simulated motors; model.delay tells the law how late real ones are");
  }
  if (key == "device.friction") {
    throw FieldError(
        "device.friction: belongs to simulated motors; the friction of a real device "
        "stands in the arm's file");
  }
}

// Says the damping [N m s/rad] as slides have it; empty without slides.
std::string of_slides(const ArmDescription& arm, double damping) {
  const auto slides = slides_of(arm);
  if (std::ranges::find(slides, true) == slides.end()) return {};
  return fmt::format(" (slides: {:.3g} N s/m)", damping / (kSlideUnit * kSlideUnit));
}

void refuse_fixed(const ParameterInfo& info) {
  if (info.live) return;
  throw FieldError(std::string(info.key) +
                   ": cannot change after the loop is made; make another loop");
}

}  // namespace

LibraryPlan read_plan(const LoopOptions& options, LoopArm of) {
  for (const std::string& setting : options.settings) {
    refuse_simulated(key_of_setting(setting), of);
  }
  LibraryPlan all;
  RunPlan& plan = all.plan;
  plan.arm = read_arm(options);
  all.notes = plan.arm.warnings;
  plan.document = read_scene_of(options, plan.arm);
  plan.models = build_meshes(plan.document);
  const Parameters asked = chosen(options, {});
  Parameters fit = fitted(plan.arm, asked);
  if (of != LoopArm::own && std::isnan(asked.damping)) {
    if (!std::isnan(fit.damping)) {
      all.notes.push_back(
          fmt::format("the arm's joints have no damping: gains are fitted as if they had {:.3g} N "
                      "m s/rad{}, and "
                      "the energy account counts no damping; set the real value in device.damping",
                      fit.damping, of_slides(plan.arm, fit.damping)));
    }
    fit.damping = kFromArm;
  }
  plan.parameters = chosen(options, fit);
  for (std::string& warning : mesh_warnings(plan.document.scene, plan.models)) {
    all.notes.push_back(std::move(warning));
  }
  if (const std::string text = fit_text(fit); !text.empty()) {
    all.notes.push_back("gains fitted to the arm, except those that are set: " + text);
  }
  for (std::string& note : notes_on(plan.arm, plan.parameters))
    all.notes.push_back(std::move(note));
  return all;
}

HandPath hand_of_rows(std::span<const double> rows) {
  constexpr std::size_t kNumbers = 4;
  if (rows.size() % kNumbers != 0 || rows.size() < 2 * kNumbers) {
    throw FileError(fmt::format(
        "path: has {} numbers; needed: at least two rows of time [s], x, y, z [m]", rows.size()));
  }
  std::vector<double> time;
  std::vector<Vec3> position;
  time.reserve(rows.size() / kNumbers);
  position.reserve(rows.size() / kNumbers);
  for (std::size_t at = 0; at < rows.size(); at += kNumbers) {
    const auto row = rows.subspan(at, kNumbers);
    const double t = row[0] - rows[0];
    const Vec3 point(row[1], row[2], row[3]);
    if (!std::isfinite(t) || !point.allFinite()) {
      throw FileError(fmt::format("path: row {}: is not finite", time.size() + 1));
    }
    if (!time.empty() && t <= time.back()) {
      throw FileError(fmt::format("path: row {}: time {} follows time {}; needed: a later time",
                                  time.size() + 1, row[0], rows[0] + time.back()));
    }
    time.push_back(t);
    position.push_back(point);
  }
  return hand_through(std::move(time), std::move(position), "path");
}

SafetyLimits limits_of(const LoopLimits& wanted) {
  SafetyLimits limits;
  const std::array values{wanted.joint_speed, wanted.tip_speed, wanted.tip_force, wanted.energy,
                          wanted.range};
  static_assert(values.size() == kSafetyLimits.size());
  for (std::size_t i = 0; i < values.size(); ++i) set_value(kSafetyLimits[i], limits, values[i]);
  return limits;
}

std::string meant_or(std::string_view name, const std::vector<std::string>& all, const char* list) {
  const auto meant = nearest(name, all);
  return meant ? fmt::format("did you mean {}?", *meant)
               : fmt::format("{} lists all of them", list);
}

const ParameterInfo& setting_named(std::string_view key) {
  if (const ParameterInfo* const info = find_parameter(key)) return *info;
  std::vector<std::string> keys;
  for (const ParameterInfo& each : parameter_table()) keys.emplace_back(each.key);
  throw FieldError(
      fmt::format("{}: no such key; {}", key,
                  meant_or(key, keys, "setting_list(), in Python limpid.settings(),")));
}

void set_live(Parameters& p, const std::string& key_value, LoopArm of) {
  refuse_simulated(key_of_setting(key_value), of);
  Parameters changed = p;
  apply_setting(changed, key_value);
  for (const ParameterInfo& info : parameter_table()) {
    if (value_of(info, changed) != value_of(info, p)) refuse_fixed(info);
  }
  p = changed;
}

void set_live(Parameters& p, std::string_view key, double value, LoopArm of) {
  refuse_simulated(key, of);
  const ParameterInfo& info = setting_named(key);
  refuse_fixed(info);
  if (info.kind != FieldInfo::Kind::flag) return set_value(info, p, value);
  if (value != 0 && value != 1) {
    throw FieldError(fmt::format("{}: {} is not allowed; allowed: 0 or 1", key, value));
  }
  set_value(info, p, value != 0);
}

}  // namespace limpid
