#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/base/folders.h"
#include "app/run/reach_check.h"
#include "app/run/run_key.h"
#include "app/run/shipped_files.h"
#include "app/sweep/body_axis.h"
#include "app/sweep/read_axes.h"
#include "app/sweep/sweep_plan.h"
#include "devices/files/config_file.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/text_file.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestPlan = 1 << 20;  // [bytes]
constexpr std::uint64_t kMostPoints = 100'000'000, kMostBlocks = 1000;
constexpr std::size_t kMostWorlds = 1000;
constexpr Range kRunSeconds{0, 3600, true, "s"};
constexpr Range kMetres{-10, 10, false, "m"};
constexpr Range kPress{0, 1000, true, "N"};

// Returns the keys that an axis decides: its own, or those of its cases.
std::set<std::string> decided_by(const SweepAxis& axis) {
  if (!axis.key.empty()) return {axis.key};
  std::set<std::string> keys;
  for (const SweepCase& one : axis.cases) {
    for (const std::string& setting : one.settings) keys.insert(key_of_setting(setting));
    if (!one.world.device.empty()) keys.insert("device");
    if (!one.world.scene.empty()) keys.insert("scene");
    if (!one.world.hand.empty()) keys.insert("hand");
  }
  return keys;
}

// State while a plan is read.
class Reader {
 public:
  Reader(const TomlTable& file, const std::string& where, SweepPlan& plan)
      : file_(file), where_(where), plan_(plan) {}

  void read() {
    refuse_refine();
    file_.allow_only({"title", "device", "scene", "hand", "seconds", "seed", "samples", "repeats",
                      "block", "set", "measure", "axis", "stop", "boundary", "figure"});
    plan_.title = file_.text("title").value_or(plan_.file.stem().string());
    plan_.seed = file_.count("seed", 0, std::numeric_limits<std::int64_t>::max()).value_or(0);
    plan_.samples = file_.count("samples", 1, kMostPoints).value_or(1);
    plan_.repeats = file_.count("repeats", 1, 1'000'000).value_or(1);
    read_settings();
    read_hand();
    plan_.world.device = file_.text("device").value_or("");
    plan_.world.scene = file_.text("scene").value_or("");
    read_axes();
    read_measures();
    read_figure();
    plan_.block = file_.count("block", 1, 1'000'000)
                      .value_or(std::clamp<std::uint64_t>(plan_.points() / kMostBlocks, 1, 1000));
  }

 private:
  void refuse_refine() const {
    const toml::node* refine = file_.find("refine");
    if (refine == nullptr) return;
    throw FileError(
        fmt::format("{}:{}: refine: limpid no longer refines maps; remove [refine]. Instead give "
                    "the axes a larger count, sweep the part of interest with its own plan, or "
                    "search for an edge with [boundary]",
                    where_, refine->source().begin.line));
  }

  // An inner table; nothing if there is none.
  std::optional<TomlTable> table(const TomlTable& in, const char* key, const char* path) const {
    const toml::node* node = in.find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_table()) in.refuse(key, fmt::format("a table [{}]", path));
    return TomlTable(*node->as_table(), where_, path);
  }

  void read_settings() {
    try {
      plan_.settings = file_.texts("set");
      for (const std::string& setting : plan_.settings) apply_setting(plan_.parameters, setting);
    } catch (const ParameterError& error) {
      file_.refuse("set", error.what());
    }
  }

  void read_hand() {
    if (const auto seconds = file_.number("seconds", kRunSeconds)) plan_.seconds = *seconds;
    const toml::node* node = file_.find("hand");
    if (node == nullptr || node->is_string()) {
      plan_.world.hand = file_.text("hand").value_or("");
      return;
    }
    const auto hand = table(file_, "hand", "hand");
    hand->allow_only({"at", "jump", "tap"});
    plan_.tap = hand->number("tap", kPress);
    if (plan_.tap) return read_tap(*hand);
    plan_.jump = {hand->need(hand->vector("at", kMetres), "at"),
                  hand->vector("jump", kMetres).value_or(Vec3::Zero())};
    if (plan_.seconds == 0) file_.refuse_missing("seconds");
    if (plan_.repeats > 1)
      file_.refuse("repeats", "1, because a hand that jumps makes all repeats equal");
  }

  // Refuses other keys beside a tap, which makes its own wall and path.
  void read_tap(const TomlTable& hand) const {
    for (const char* key : {"at", "jump"}) {
      if (hand.find(key) != nullptr)
        hand.refuse(key, "none, because a hand that taps finds its own way");
    }
    if (file_.find("scene") != nullptr)
      file_.refuse("scene", "none, because a tap test has its own wall");
    if (plan_.repeats > 1)
      file_.refuse("repeats", "1, because a hand that taps makes all repeats equal");
  }

  void read_axes() {
    std::vector<ReadAxis> axes;
    std::set<std::string> names;
    bool sampled = false;
    for (const TomlTable& each : file_.tables("axis")) {
      axes.push_back(read_axis(each, plan_.parameters));
      sampled = sampled || axes.back().axis.spread != Spread::grid;
      if (axes.back().axis.key.starts_with("arm.") && !plan_.tap) {
        each.refuse("key", "arm.joints, arm.mass, arm.seed only with hand = { tap = NEWTONS }");
      }
      if (axes.back().axis.key.starts_with(kBodyKey) && plan_.tap) {
        each.refuse("key", "no key of a body, because a tap test has its own wall");
      }
      if (!names.insert(axes.back().axis.name).second) {
        each.refuse(each.find("name") ? "name" : "key", "a name that no other axis has");
      }
      claim(each, axes.back().axis);
    }
    if (sampled && plan_.samples < 2) file_.refuse_missing("samples");
    if (!sampled && plan_.samples > 1)
      file_.refuse("samples", "no value, because no axis is sampled");
    read_boundary();
    // Checked before drawing more points than memory holds.
    double points = static_cast<double>(plan_.samples * plan_.repeats);
    for (const ReadAxis& read : axes) {
      if (read.axis.spread == Spread::grid) points *= static_cast<double>(read.axis.values.size());
    }
    if (points > kMostPoints) {
      throw FileError(
          fmt::format("{}: {:.4g} points; allowed: up to {}", where_, points, kMostPoints));
    }
    sample(axes, plan_.samples, plan_.seed);
    for (ReadAxis& read : axes) plan_.axes.push_back(std::move(read.axis));
  }

  // Refuses an axis that would have no effect: another one decides the same, or the hand does.
  void claim(const TomlTable& table, const SweepAxis& axis) {
    const char* const where = table.find("cases") != nullptr ? "cases" : "key";
    for (const std::string& key : decided_by(axis)) {
      if (key == "scene" && plan_.tap)
        table.refuse(where, "no scene, because a tap test has its own wall");
      if (key == "hand" && (plan_.tap || plan_.jump)) {
        table.refuse(where, "no hand, because the plan's own `hand` is not a file");
      }
      const bool random = key.starts_with("arm.");
      const bool of_arms = random || key == "device";
      if (of_arms && decided_.contains(random ? "device" : "arm.")) {
        table.refuse(where,
                     "either device, or arm.joints, arm.mass and arm.seed, because a random arm is "
                     "not a device");
      }
      if (random) decided_.insert("arm.");
      if (decided_.insert(key).second) continue;
      table.refuse(where, fmt::format("a key that no other axis sets; {} is set already", key));
    }
  }

  void read_boundary() {
    const auto boundary = table(file_, "boundary", "boundary");
    if (!boundary) return;
    boundary->allow_only({"axis", "measure", "above", "below", "tolerance"});
    const auto axis = table(*boundary, "axis", "boundary.axis");
    if (!axis) boundary->refuse_missing("axis");
    SweepBoundary& b = plan_.boundary.emplace();
    b.axis = read_axis(*axis, plan_.parameters).axis;
    claim(*axis, b.axis);
    if (!b.axis.words.empty() || b.axis.values.size() < 2) {
      boundary->refuse("axis", "numbers from, to and a count of at least 2");
    }
    std::ranges::sort(b.axis.values);
    b.condition = read_limit(*boundary);
    b.tolerance = boundary->need(boundary->number("tolerance", {0, 1e9, true}), "tolerance");
  }

  void read_measures() {
    for (const std::string& name : file_.texts("measure")) {
      const MeasureInfo* measure = find_measure(name);
      if (measure == nullptr) {
        std::vector<std::string> names;
        for (const MeasureInfo& each : measure_table()) names.emplace_back(each.name);
        const auto meant = nearest(name, names);
        file_.refuse("measure",
                     fmt::format("{}: there is no such measure; {}a list of measures from: {}",
                                 name, meant ? fmt::format("did you mean {}? ", *meant) : "",
                                 fmt::join(names, ", ")));
      }
      plan_.measures.push_back(measure);
    }
    if (plan_.boundary && !plan_.measures.empty()) {
      file_.refuse("measure",
                   "no value, because a sweep with a boundary measures only the boundary");
    }
    if (!plan_.boundary && plan_.measures.empty()) file_.refuse_missing("measure");
    for (const TomlTable& each : file_.tables("stop")) {
      each.allow_only({"measure", "above", "below", "after"});
      plan_.stops.push_back({read_limit(each), each.number("after", kRunSeconds).value_or(0)});
    }
  }

  void read_figure() {
    const auto figure = table(file_, "figure", "figure");
    if (!figure) return;
    figure->allow_only({"x", "y", "measure", "theory", "caption"});
    const auto axis = [&](const char* key) {
      std::string name = figure->text(key).value_or("");
      const bool known =
          std::ranges::any_of(plan_.axes, [&](const SweepAxis& a) { return a.name == name; });
      if (!name.empty() && !known) figure->refuse(key, "the name of an axis");
      return name;
    };
    plan_.figure = {axis("x"), axis("y"), figure->text("measure").value_or(""),
                    figure->texts("theory"), figure->text("caption").value_or("")};
    const auto measured = [&](const MeasureInfo* m) { return plan_.figure.measure == m->name; };
    if (!plan_.figure.measure.empty() && std::ranges::none_of(plan_.measures, measured)) {
      figure->refuse("measure", "a measure that the plan measures");
    }
    for (const std::string& line : plan_.figure.theory) {
      if (std::ranges::find(kTheories, line) == std::end(kTheories)) {
        figure->refuse("theory",
                       "a list of names from: " +
                           allowed_for(line, {std::begin(kTheories), std::end(kTheories)}));
      }
    }
  }

  const TomlTable& file_;
  const std::string& where_;
  SweepPlan& plan_;
  std::set<std::string> decided_;  // keys that axes decide; "arm." for those of random arms
};

// Refuses axes of bodies that the scene does not have.
void check_bodies(const SweepPlan& plan, const RunPlan& run, const SweepWorld& world) {
  const auto check = [&](const std::string& key) {
    const auto axis = body_axis(key);
    const std::string why = axis ? why_not(*axis, run.document.scene) : "";
    if (why.empty()) return;
    throw FileError(fmt::format("{}: {}: scene {}: {}", plan.file.string(), key,
                                world.scene.empty() ? "table.toml" : world.scene, why));
  };
  for (const SweepAxis& axis : plan.axes) check(axis.key);
  if (plan.boundary) check(plan.boundary->axis.key);
}

// Reads arm, scene and hand.
RunPlan read_world(const SweepPlan& plan, const SweepWorld& world) {
  const auto file = [&](const std::string& name, const char* kind, const fs::path& otherwise) {
    if (name.empty()) return otherwise;
    fs::path found = beside_or_own(plan.file.parent_path(), kind, name);
    if (fs::exists(found)) return found;
    throw FileError(fmt::format("{}: file \"{}\" not found, neither beside the plan nor in {}{}",
                                plan.file.string(), name, (data_dir() / "assets" / kind).string(),
                                shipped_hint(name, {kind})));
  };
  RunPlan run;
  run.arm = read_urdf(file(world.device, "devices", default_device()), {}, plan.xacro);
  run.document = read_scene(file(world.scene, "scenes", default_scene()), run.arm);
  run.models = build_meshes(run.document);
  if (plan.tap) return run;
  if (plan.jump) {
    run.hand.time = {0, 1e-3};
    run.hand.position = {plan.jump->at, plan.jump->at + plan.jump->by};
    run.hand.velocity.assign(2, Vec3::Zero());
    run.hand.grip.assign(2, 1);
    run.hand.source = "a jump";
  } else {
    run.hand = limpid::read_hand(file(world.hand, "hands", default_hand()));
    // The same wherever the plan lies.
    run.hand.source = world.hand.empty() ? default_hand().filename().string() : world.hand;
  }
  if (const std::string why = out_of_reach(run); !why.empty()) {
    throw FileError(fmt::format("{}: {}{}; hand = {{ tap = 1 }} suits any arm", plan.file.string(),
                                world.hand.empty() ? "the default hand" : "", why));
  }
  return run;
}

}  // namespace

// Reads the worlds of every combination of cases.
void read_worlds(SweepPlan& plan) {
  std::set<SweepWorld> worlds{plan.world};
  for (const SweepAxis& axis : plan.axes) {
    if (axis.cases.empty()) continue;
    std::set<SweepWorld> all;
    for (const SweepWorld& world : worlds) {
      for (const SweepCase& one : axis.cases) all.insert(world.with(one.world));
    }
    worlds = std::move(all);
    if (worlds.size() > kMostWorlds) {
      throw FileError(fmt::format("{}: more than {} combinations of device, scene and hand",
                                  plan.file.string(), kMostWorlds));
    }
  }
  Digest digest;
  digest.add(plan.text);
  for (const SweepWorld& world : worlds) {
    auto run = std::make_shared<RunPlan>(read_world(plan, world));
    check_bodies(plan, *run, world);
    digest.add(trial_key(*run, 0));
    plan.worlds[world] = std::move(run);
  }
  plan.key = digest.value();
}

SweepPlan plan_of_text(std::string text, const fs::path& file) {
  SweepPlan plan;
  plan.file = file;
  plan.text = std::move(text);
  const std::string where = file.string();
  const toml::table table = parse_toml(plan.text, where);
  Reader(TomlTable(table, where, ""), where, plan).read();
  return plan;
}

SweepPlan read_sweep_plan(const fs::path& file, Xacro xacro) {
  SweepPlan plan = plan_of_text(read_text(file, kLongestPlan), file);
  plan.xacro = xacro;
  read_worlds(plan);
  return plan;
}

}  // namespace limpid
