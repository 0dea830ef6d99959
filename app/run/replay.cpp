#include "app/run/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/folders.h"
#include "app/base/version.h"
#include "app/run/program_build.h"
#include "app/run/scene_meshes.h"
#include "devices/files/config_file.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/urdf_file.h"

namespace limpid {

SessionInfo session_info(const RunPlan& plan) {
  SessionInfo info;
  info.tick = plan.parameters.tick;
  info.dof = plan.arm.dof();
  info.bodies = body_names(plan.document.scene);
  info.app_version = program_version();
  info.build = program_build();
  info.seed = plan.seed;
  info.source = plan.hand.source;
  info.config = config_text(plan.parameters);
  info.device_urdf = plan.arm.urdf;
  info.scene = plan.document.toml;
  info.models = files_of(plan.document);
  info.arm = std::make_shared<const ArmDescription>(plan.arm);
  for (const Lane& lane : plan.beside) info.beside.push_back(config_text(lane.parameters));
  return info;
}

void tell_start(Recorder& recorder, const RunPlan& plan) {
  for (std::size_t lane = 0; lane < plan.lanes(); ++lane) {
    const auto& start = plan.lane(lane).start ? plan.lane(lane).start : plan.start;
    if (start) recorder.begins(start->world, lane);
  }
}

Parameters session_parameters(const Session& session, const std::string& where) {
  Parameters own;
  apply_config_text(own, session.info.config, where + " (config)");
  own.tick = session.info.tick;
  return own;
}

namespace {

// Parses text from a session, with the built-in pictures if it names those.
template <class Parse>
auto with_pictures(const std::filesystem::path& folder, const Parse& parse) {
  try {
    return parse(folder);
  } catch (const FileError&) {
    return parse(std::filesystem::path());
  }
}

// Returns the changes made while recording, but for keys that are now set otherwise than at its
// beginning.
std::vector<SettingChange> changes_again(const Session& run, const std::string& where,
                                         const Parameters& own, const Parameters& chosen) {
  std::vector<SettingChange> changes;
  Parameters tried = own;
  for (const SettingChange& change : run.changes) {
    try {
      apply_change(tried, change);
    } catch (const ParameterError& e) {
      throw FileError(fmt::format("{}: /events/setting: {}", where, e.what()));
    }
    const ParameterInfo* info = find_parameter(change.key());
    if (info != nullptr && parameter_text(own, *info) == parameter_text(chosen, *info)) {
      changes.push_back(change);
    }
  }
  return changes;
}

// Makes changes to the first lane's settings in another lane's, too, but for those in which the two
// differed: these are what the lanes compare.
Parameters with_changed(Parameters other, const Parameters& began, const Parameters& chosen) {
  for (const ParameterInfo& info : parameter_table()) {
    const std::string was = parameter_text(began, info);
    if (parameter_text(chosen, info) == was || parameter_text(other, info) != was) continue;
    set_parameter_number(other, info, parameter_number(chosen, info));
  }
  return other;
}

// Whether the predictive law ran with encoder steps and without a memory of its own, in a session
// from before readings were weighed.
bool had_another_filter(const Session& session, const std::string& where) {
  for (std::size_t i = 0; i < session.lanes(); ++i) {
    const Session& lane = session.lane(i);
    if (!has_retired(lane.info.config, where)) continue;
    Parameters p = session_parameters(lane, where);
    const auto weighs = [&p] {
      return p.kind == CouplingKind::predictive && p.gains(p.encoder_step).weighs();
    };
    if (weighs()) return true;
    for (const SettingChange& change : lane.changes) {
      apply_change(p, change);
      if (weighs()) return true;
    }
  }
  return false;
}

RigStart start_of(const Session& run) {
  RigStart start = start_of(run.layout, run.row(0));
  start.world = run.world;
  return start;
}

// Gives the virtual arm those own forces of the real device that its motors held.
void give_forces(RunPlan& plan) {
  plan.parameters.weighs = plan.parameters.holds_weight;
  plan.parameters.springy = plan.parameters.holds_springs;
  std::vector<SettingChange> changes;
  for (const SettingChange& change : plan.changes) {
    changes.push_back(change);
    for (const char* force : {"gravity", "springs"}) {
      const std::string key = std::string("model.") + force;
      if (change.key() != key) continue;
      changes.push_back(
          {change.row, std::string("device.") + force + change.setting.substr(key.size())});
    }
  }
  plan.changes = std::move(changes);
}

}  // namespace

RunPlan replay(const Session& session, const std::string& where, const Parameters& chosen) {
  const std::filesystem::path assets = data_dir() / "assets";
  RunPlan plan;
  plan.arm = parse_urdf(session.info.device_urdf, where + " (device_urdf)", assets / "devices");
  plan.document = with_pictures(assets / "scenes", [&](const std::filesystem::path& folder) {
    return parse_scene(session.info.scene, where + " (scene)", folder, plan.arm,
                       session.info.models);
  });
  if (const int bodies = count_bodies(plan.document.scene); bodies != session.layout.bodies()) {
    throw FileError(fmt::format("{}: /objects/pose: {} bodies; needed: {}, as the scene has", where,
                                session.layout.bodies(), bodies));
  }
  plan.models = build_meshes(plan.document);
  plan.hand = hand_of(session, where);
  plan.parameters = chosen;
  plan.parameters.tick = session.info.tick;
  plan.start = start_of(session);
  plan.rows = session.size();
  plan.note = other_build(session.info.build, where);
  if (had_another_filter(session, where)) {
    plan.note +=
        "; Limpid no longer has the filter of encoder steps that this recording used, so the "
        "numbers differ";
  }
  plan.seed = session.info.seed;
  // A real device has no measured hand torque: the observer's estimate acts in its place. It has
  // the excitation in it.
  const bool measured = !std::isnan(session.at(0, Column::hand_torque)[0]);
  for (std::size_t k = 0; k < session.size(); ++k) {
    const auto estimate = session.at(k, Column::hand_torque_estimate);
    if (!measured)
      plan.hand_torque.insert(plan.hand_torque.end(), estimate.begin(), estimate.end());
    plan.force.push_back(session.at(k, Column::force_wanted)[0] != 0);
    const auto excitation = session.at(k, Column::excitation);
    if (!measured || std::ranges::all_of(excitation, [](double f) { return f == 0; })) continue;
    plan.excitation.resize(k + 1, Vec3::Zero());
    plan.excitation[k] = Vec3(excitation[0], excitation[1], excitation[2]);
  }

  plan.changes = changes_again(session, where, session_parameters(session, where), chosen);
  if (!measured) give_forces(plan);
  for (std::size_t i = 1; i < session.lanes(); ++i) {
    const Session& lane = session.lane(i);
    const std::string of_lane = fmt::format("{} ({})", where, lane_name(i));
    const Parameters own = session_parameters(lane, of_lane);
    Lane& again = plan.beside.emplace_back();
    again.parameters = with_changed(own, session_parameters(session, where), chosen);
    again.parameters.tick = session.info.tick;
    again.changes = changes_again(lane, of_lane, own, again.parameters);
    again.start = start_of(lane);
  }
  return plan;
}

}  // namespace limpid
