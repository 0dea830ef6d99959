// `limpid check`: reports what a file contains, before it is used.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>

#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/run/analysis.h"
#include "app/run/body_report.h"
#include "app/run/fitted_gains.h"
#include "app/run/model_report.h"
#include "app/run/provenance.h"
#include "app/run/reach_check.h"
#include "app/run/run_notes.h"
#include "app/run/scene_flaws.h"
#include "app/stage/load_files.h"
#include "app/story/story.h"
#include "app/sweep/sweep_plan.h"
#include "app/sweep/sweep_table.h"
#include "core/base/model_kinds.h"
#include "core/dynamics/arm.h"
#include "core/dynamics/farthest_tip.h"
#include "core/tick/safety_limits.h"
#include "devices/files/scene/scene_document.h"
#include "devices/files/session/hand_file.h"
#include "devices/files/text_file.h"
#include "devices/files/toml_reader.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

struct CheckOptions {
  std::string file;
  InputOptions input;
  bool json = false;
};

// Lines of the report for people.
struct CheckReport {
  std::vector<std::string> facts, warnings;
};

// Describes a joint; slides in m, N, N s/m and kg.
std::string joint_line(const Joint& joint, const Link& link, double inertia) {
  const bool slides = joint.kind == Joint::Kind::prismatic;
  const double unit = slides ? kSlideUnit : 1;
  const std::string range = std::isfinite(joint.upper - joint.lower)
                                ? fmt::format("{:.3g} to {:.3g} {}", unit * joint.lower,
                                              unit * joint.upper, slides ? "m" : "rad")
                                : "no limits";
  return fmt::format("  {:<26} {:>18} {:>7.3g} {:<4} {:>7.2g} {:<6} {:>7.3g} kg {:>8.2g} {}",
                     joint.name, range, joint.effort / unit, slides ? "N" : "N m",
                     joint.damping / (unit * unit), slides ? "N s/m" : "N m s", link.mass,
                     inertia / (unit * unit), slides ? "kg" : "kg m^2");
}

void list_joints(const ArmDescription& arm, const Eigen::MatrixXd& M, CheckReport& report) {
  report.facts.push_back(fmt::format("  {:<26} {:>18} {:>12} {:>14} {:>10} {:>15}", "joint",
                                     "range", "effort", "damping", "link mass", "inertia at rest"));
  for (int i = 0; i < arm.dof(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    report.facts.push_back(joint_line(arm.joints[k], arm.links[k], M(i, i)));
  }
}

void list_gains(const ArmDescription& arm, const Eigen::VectorXd& rest, const Parameters& p,
                CheckReport& report) {
  const std::string fit = fit_text(p);
  report.facts.push_back(fit.empty() ? "gains        the paper's gains suit this arm"
                                     : "gains        fitted: " + fit);
  const Analysis a = analyze(arm, rest, p, std::nullopt);
  report.facts.push_back("             for " + basis_text(arm, p));
  report.facts.push_back(
      fmt::format("             condition (3) {}; by equation (25) the proposed law is passive at "
                  "an eta of {:.2f} or above",
                  a.condition3.holds ? "is met" : "is BROKEN", a.eta_min));
  if (const std::string weak = weak_spring_text(arm, p); !weak.empty()) {
    report.facts.push_back("             note: " + weak);
  }
  if (const std::string filed = readings_text(arm, p); !filed.empty()) {
    report.facts.push_back("readings     " + filed +
                           "; --readings takes the values of the arm's file");
  }
  if (!a.condition3.holds) {
    report.warnings.push_back(
        "condition (3) is not met with these settings: reduce coupling.k_vc or coupling.b_vc, or "
        "set neither of them; Limpid then fits both to the arm");
    const std::string late = fit_text(fitted(arm, p, a.delay, p));
    if (!a.condition3.known) {
      report.warnings.back() =
          "condition (3): no limit is known where packets are lost (link.loss)";
    } else if (a.delay + a.link > 0) {
      report.warnings.back() += "; gains that fulfil condition (3) with this delay: " + late;
    }
  }
}

// Lists the limits on the motors' torque, which hold for any gains.
void list_limits(const Parameters& p, CheckReport& report) {
  report.facts.push_back(
      fmt::format("limits       torque {}, reached in {:.0f} ms at the earliest; force at a real "
                  "device's tip: {:.0f} N",
                  std::isfinite(p.torque_limit) ? fmt::format("{:.3g} N m", p.torque_limit)
                                                : "as in the column effort",
                  1000 * SafetyLimits::kSlew, SafetyLimits{}.tip_force));
}

// A slide longer than this is meant to have no limits [m].
constexpr double kFar = 100;

constexpr double kLongestArm = 10;  // that a hand may lead [m]
// A joint with limits that turns further has them in degrees [rad].
constexpr double kMostTurned = 4 * std::numbers::pi;

// Warns of lengths in mm and of limits in degrees, which are the usual slips.
void list_units(const ArmDescription& arm, double reach, CheckReport& report) {
  const auto travel = [](const Joint& joint) { return joint.upper - joint.lower; };
  double slides = 0;
  for (const Joint& joint : arm.joints) {
    if (joint.kind == Joint::Kind::prismatic) {
      slides += kSlideUnit * travel(joint);
    } else if (std::isfinite(travel(joint)) && travel(joint) > kMostTurned) {
      report.warnings.push_back(fmt::format(
          "joint '{}' turns by {:.3g} full turns, from {:.3g} to {:.3g} rad; are the limits in "
          "degrees? <limit> needs rad",
          joint.name, travel(joint) / (2 * std::numbers::pi), joint.lower, joint.upper));
    }
  }
  if (reach > kLongestArm && slides <= kLongestArm) {
    report.warnings.push_back(
        fmt::format("the arm is {:.3g} m long; are the lengths in mm? URDF needs m", reach));
  }
}

void list_reach(const ArmDescription& arm, double mass, CheckReport& report) {
  const double most = farthest_tip(arm).distance;
  report.facts.push_back(fmt::format(
      "reach        {:.3g} m from the origin of joint '{}' to '{}', moving mass {:.3g} kg", most,
      arm.joints.front().name, arm.tip_link, mass));
  list_units(arm, most, report);
  if (most < kFar) return;
  for (const Joint& joint : arm.joints) {
    if (joint.kind != Joint::Kind::prismatic) continue;
    const double travel = kSlideUnit * (joint.upper - joint.lower);
    if (travel < kFar) continue;
    report.warnings.push_back(fmt::format(
        "joint '{}' slides through {:.3g} m; write the joint's real range of motion in <limit>",
        joint.name, travel));
  }
}

// Warns of impossible moments of inertia: CAD exports them in g mm^2, or somebody invented them.
void list_inertias(const ArmDescription& arm, CheckReport& report) {
  constexpr double kRounded = 1.01;  // rounding of a thin plate's moments in files
  const double reach = farthest_tip(arm).distance;
  for (const Link& link : arm.links) {
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(link.inertia, Eigen::EigenvaluesOnly);
    const Vec3& moments = solver.eigenvalues();
    if (2 * moments.z() > kRounded * moments.sum()) {
      report.warnings.push_back(
          fmt::format("link '{}': principal moments of {:.3g}, {:.3g} and {:.3g} kg m^2 are "
                      "impossible: each moment must be at most the sum of the other two",
                      link.name, moments.x(), moments.y(), moments.z()));
    }
    const double ring = std::sqrt(moments.z() / link.mass);
    if (link.mass > 0 && ring > std::max(1.0, 2 * reach)) {
      report.warnings.push_back(
          fmt::format("link '{}': a moment of {:.3g} kg m^2 with {:.3g} kg would need a ring of "
                      "{:.3g} m radius; are the link's moments given in kg m^2?",
                      link.name, moments.z(), link.mass, ring));
    }
  }
}

CheckReport on_arm(const std::string& file, const InputOptions& input) {
  const ArmDescription arm = load_arm(file, input.tip, Xacro::expand).arm;
  require_readings(input, arm);
  CheckReport report{{}, arm.warnings};
  double mass = 0;
  for (const Link& link : arm.links) mass += link.mass;
  const std::size_t pictures = static_cast<std::size_t>(std::ranges::count_if(
      arm.visuals, [](const Visual& v) { return v.shape != Visual::Shape::stand_in; }));
  report.facts.push_back(
      fmt::format("arm          {}, {} joints to '{}'", arm.name, arm.dof(), arm.tip_link));
  list_reach(arm, mass, report);
  report.facts.push_back(pictures == 0 ? "picture      capsules from joint to joint"
                                       : fmt::format("picture      {} shapes", pictures));
  const Eigen::VectorXd rest = rest_pose(arm);
  const Eigen::MatrixXd M = arm_at(arm, rest).M;
  list_joints(arm, M, report);
  list_inertias(arm, report);
  const Parameters p = make_parameters(input, arm);
  list_gains(arm, rest, p, report);
  list_limits(p, report);
  return report;
}

void list_mesh(const std::string& name, const Mesh& mesh, const Model& model, CheckReport& report) {
  const Vec3 size = mesh.size() * model.bounds().sizes();
  report.facts.push_back(fmt::format("model        {}, {} triangles, {:.3g} x {:.3g} x {:.3g} m",
                                     name, model.indices.size() / 3, size.x(), size.y(), size.z()));
}

// Parameters with the law that is named; else with the window's first law, which renders the most.
Parameters law_to_check(const InputOptions& input, const ArmDescription& arm) {
  Parameters p = make_parameters(input, arm);
  Parameters usual;
  usual.kind = CouplingKind::predictive;
  p.kind = make_parameters(input, usual).kind;
  return p;
}

CheckReport on_scene(const std::string& file, const InputOptions& input) {
  const ArmDescription arm = arm_of(input);
  const LoadedScene loaded = load_scene(file, arm);
  const std::vector<Object>& objects = loaded.document.scene.objects;
  CheckReport report{{}, loaded.warnings};
  report.facts.push_back(fmt::format("scene        {}", loaded.document.title));
  if (objects.empty()) {
    report.facts.emplace_back("to touch     nothing");
    if (loaded.document.about.empty()) {
      report.warnings.emplace_back(
          "the scene has nothing to touch; if this is intended, say so in the file's key `about`");
    }
    return report;
  }
  report.facts.push_back(
      fmt::format("to touch     planes {}, spheres {}, boxes {}, cylinders {}, capsules {}, "
                  "models {}, stops of joints {}",
                  std::ranges::count_if(objects, has_shape<Plane>),
                  std::ranges::count_if(objects, has_shape<Sphere>),
                  std::ranges::count_if(objects, has_shape<Box>),
                  std::ranges::count_if(objects, has_shape<Cylinder>),
                  std::ranges::count_if(objects, has_shape<Capsule>),
                  std::ranges::count_if(objects, has_shape<Mesh>),
                  std::ranges::count_if(objects, has_shape<JointStop>)));
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto* mesh = std::get_if<Mesh>(&objects[i].shape);
    if (mesh != nullptr) list_mesh(objects[i].name, *mesh, *loaded.models[i], report);
  }
  const Parameters p = law_to_check(input, arm);
  BodyReport bodies = report_on_bodies(loaded.document.scene, arm);
  std::ranges::move(bodies.facts, std::back_inserter(report.facts));
  std::ranges::move(bodies.warnings, std::back_inserter(report.warnings));
  std::ranges::move(quick_mechanisms(loaded.document.scene, p.tick),
                    std::back_inserter(report.warnings));
  std::ranges::move(scene_flaws(loaded.document.scene, arm, p),
                    std::back_inserter(report.warnings));
  return report;
}

CheckReport on_model(const std::string& file) {
  ModelReport report = report_on_model(file);
  return {std::move(report.facts), std::move(report.warnings)};
}

// Warns of the path's fastest part if it is faster than a device's tip may be: times in ms and
// positions in mm are the usual slips.
void list_speed(const HandPath& hand, CheckReport& report) {
  double fastest = SafetyLimits{}.tip_speed, when = -1;
  for (std::size_t i = 1; i < hand.time.size(); ++i) {
    const double moved = (hand.position[i] - hand.position[i - 1]).norm();
    const double speed = moved / (hand.time[i] - hand.time[i - 1]);
    if (speed > fastest) fastest = speed, when = hand.time[i - 1];
  }
  if (when < 0) return;
  report.warnings.push_back(fmt::format(
      "the hand moves at {:.3g} m/s at {:.3f} s; a hand at a device's tip stays below {:g} m/s, "
      "above which a real device's force fades; are the times in s, and the positions in m?",
      fastest, when, SafetyLimits{}.tip_speed));
}

CheckReport on_hand(const std::string& file, const InputOptions& input) {
  RunPlan plan;
  plan.arm = arm_of(input);
  plan.hand = read_hand(file);
  Bounds box;
  for (const Vec3& each : plan.hand.position) box.extend(each);
  const Vec3 spans = 1e3 * box.sizes();
  CheckReport report;
  report.facts.push_back(fmt::format(
      "hand         {} samples, {:.3g} s, in a space of {:.0f} x {:.0f} x {:.0f} mm",
      plan.hand.position.size(), plan.hand.duration(), spans.x(), spans.y(), spans.z()));
  if (std::string far = out_of_reach(plan); !far.empty()) {
    report.warnings.push_back(std::move(far));
  }
  list_speed(plan.hand, report);
  return report;
}

CheckReport on_story(const std::string& file) {
  const Story story = read_story(file);
  return {{fmt::format("story        {}: {} steps, {:.3g} s, {} runs with the same hand",
                       story.title, story.steps.size(), story.seconds(), story.plan.lanes())},
          {}};
}

CheckReport on_sweep(const std::string& file) {
  const SweepPlan plan = read_sweep_plan(file);
  CheckReport report;
  report.facts.push_back(fmt::format("sweep        {}: {} points", plan.title, plan.points()));
  for (const SweepAxis& axis : plan.axes) {
    report.facts.push_back(
        fmt::format("             {}, {} values", axis.name, axis.values.size()));
  }
  return report;
}

// Refuses options that have no effect on this kind of file.
void refuse_options(const InputOptions& input, bool world, const char* kind) {
  for (const auto& [given, option] :
       {std::pair(world && !input.device.empty(), "--device"),
        {world && !input.tip.empty(), "--tip"},
        {input.readings, "--readings"},
        {input.set_parameters(), "--set, --config, --coupling, --eta, --alpha"}}) {
    if (given) throw UsageError(fmt::format("{}: not for {}", option, kind));
  }
}

constexpr std::size_t kLongestToml = 10'000'000;  // [bytes]

// Whether a table has settings, as a file of --config has them.
bool has_settings(const toml::table& keys) {
  return std::ranges::any_of(parameter_table(), [&](const ParameterInfo& info) {
    return static_cast<bool>(keys.at_path(info.key));
  });
}

// Says what a file is that can be no scene; empty if it can be one.
const char* not_a_scene(const toml::table& keys) {
  if (has_settings(keys)) return "settings of a run, as --config reads them";
  for (const auto& [key, node] : keys) {
    const toml::table* part = node.as_table();
    if (part != nullptr && part->contains("show_plots")) return "layouts of the window";
    if (part != nullptr && has_settings(*part))
      return "presets of settings, as the window has them";
  }
  return "";
}

CheckReport on_toml(const CheckOptions& options) {
  const toml::table keys = parse_toml(read_text(options.file, kLongestToml), options.file);
  const bool story = keys.contains("step");
  if (!story && !keys.contains("axis") && !keys.contains("measure")) {
    if (const std::string_view what = not_a_scene(keys); !what.empty()) {
      throw FileError(
          fmt::format("{}: {}; needed: a scene, a story or a sweep", options.file, what));
    }
    return on_scene(options.file, options.input);
  }
  refuse_options(options.input, true,
                 story ? "a story, because the file itself says its arm, scene and settings"
                       : "a sweep, because the file itself says its arm, scene and settings");
  return story ? on_story(options.file) : on_sweep(options.file);
}

CheckReport on(const CheckOptions& options) {
  const fs::path file = options.file;
  if (const std::string why = why_not_found(file, "no such file"); !why.empty()) {
    throw FileError(fmt::format("{}: {}", options.file, why));
  }
  const std::string suffix = small_suffix(file);
  if (suffix == ".urdf" || suffix == ".xacro") {
    if (!options.input.device.empty()) throw UsageError("--device: not for an arm's own file");
    return on_arm(options.file, options.input);
  }
  if (suffix == ".toml") return on_toml(options);
  if (suffix == ".csv") {
    refuse_options(options.input, false, "a hand");
    return on_hand(options.file, options.input);
  }
  if (model_kind(file) != nullptr) {
    refuse_options(options.input, true, "a model");
    return on_model(options.file);
  }
  if (suffix == ".h5") {
    if (sweep_table_at(file)) {
      throw FileError(fmt::format("{0}: a sweep's table; `limpid play {0}` opens it in the window",
                                  options.file));
    }
    throw FileError(
        fmt::format("{0}: a recording; `limpid info {0}` shows what it contains", options.file));
  }
  throw FileError(
      fmt::format("{}: this kind of file is not known; needed: an arm (.urdf, .xacro), a scene, a "
                  "story or a sweep (.toml), a hand (.csv) or a model ({})",
                  options.file, model_suffixes()));
}

// Checks the file; whatever goes wrong is an error of the file.
CheckReport opened(const CheckOptions& options) {
  try {
    return on(options);
  } catch (const std::bad_alloc&) {
    throw FileError(options.file + ": needs more main memory (RAM) than Limpid can get");
  } catch (const std::exception& e) {
    throw FileError(e.what());
  }
}

int check(const CheckOptions& options) {
  const CheckReport report = opened(options);
  if (options.json) {
    const nlohmann::ordered_json json{{"provenance", provenance("", std::nullopt)},
                                      {"file", options.file},
                                      {"facts", report.facts},
                                      {"warnings", report.warnings}};
    fmt::print("{}\n", json.dump(2));
    return report.warnings.empty() ? 0 : 1;
  }
  for (const std::string& fact : report.facts) fmt::print("{}\n", fact);
  for (const std::string& warning : report.warnings) fmt::print("warning      {}\n", warning);
  const std::size_t n = report.warnings.size();
  fmt::print("{}\n", n == 0   ? "fine"
                     : n == 1 ? "works, with a warning"
                              : fmt::format("works, with {} warnings", n));
  return n == 0 ? 0 : 1;
}

}  // namespace

Command declare_check(CLI::App& app) {
  auto* command = app.add_subcommand(
      "check",
      "describes an arm, a scene, a model, a hand, a story or a sweep, and lists the flaws");
  auto options = std::make_shared<CheckOptions>();
  command->add_option("FILE", options->file, "an arm, a scene, a model, a hand, a story or a sweep")
      ->transform(or_shipped({"scenes", "devices", "hands", "stories", "sweeps"}), "", "")
      ->type_name("ARM.urdf|SCENE.toml|MODEL|HAND.csv")
      ->required();
  options->input.add_arm(*command);
  options->input.add_readings(*command);
  options->input.add_parameters(*command);
  command->add_flag("--json", options->json, "one JSON object on standard output");
  command->footer(
      "The report on an arm contains its chain, masses, reach and suitable gains. --tip LINK names "
      "the link\nwhere the chain ends; --device is the arm that a scene or a hand is for. Exit "
      "status: 0 fine,\n1 works, with warnings, 2 does not work; the report says why.");
  return [options] { return check(*options); };
}

}  // namespace limpid
