#include "app/cli/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "app/base/folders.h"
#include "app/device/device_hub.h"
#include "app/run/fitted_gains.h"
#include "app/run/own_world.h"
#include "app/run/reach_check.h"
#include "app/run/replay.h"
#include "app/run/scene_meshes.h"
#include "app/run/varied_hand.h"
#include "core/base/utf8.h"
#include "devices/files/config_file.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

constexpr double kLongestRun = 24 * 3600;  // [s]

bool is_session(const std::string& file) {
  return file.ends_with(".h5") || file.ends_with(".h5.part");
}

// Reads a text that is a number and nothing else.
std::optional<double> number_in(const std::string& text) {
  double x = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, x);
  if (result.ec != std::errc{} || result.ptr != end) return std::nullopt;
  return x;
}

CLI::Validator whole_number() {
  return {[](const std::string& text) -> std::string {
            constexpr auto kMost = std::numeric_limits<std::uint64_t>::max();
            std::uint64_t n = 0;
            const char* end = text.data() + text.size();
            const auto result = std::from_chars(text.data(), end, n);
            if (result.ec == std::errc{} && result.ptr == end) return {};
            return fmt::format("\"{}\" is not allowed; allowed: a whole number from 0 to {}", text,
                               kMost);
          },
          ""};
}

// Plan of a session with its own world and parameters; options override them.
RunPlan plan_from_session(const InputOptions& options) {
  const Session session = read_session(options.hand);
  if (session.size() == 0) throw FileError(options.hand + ": contains no rows");
  const Parameters chosen = make_parameters(options, session_parameters(session, options.hand));
  RunPlan plan = replay(session, options.hand, chosen);
  if (chosen.tick != session.info.tick) {
    const double ratio = session.info.tick / chosen.tick;
    const auto move = [ratio](std::vector<SettingChange>& changes) {
      for (SettingChange& change : changes) {
        const double row = static_cast<double>(change.row) * ratio;
        change.row = static_cast<std::uint64_t>(std::llround(row));
      }
    };
    move(plan.changes);
    plan.force.clear();
    plan.parameters.tick = chosen.tick;
    for (Lane& lane : plan.beside) {
      move(lane.changes);
      lane.parameters.tick = chosen.tick;
    }
  }
  if (!options.device.empty()) {
    plan.arm = arm_of(options);
    if (options.scene.empty()) {  // the scene may name joints and links, which differ here
      plan.document = parse_scene(session.info.scene, options.hand + " (scene)",
                                  data_dir() / "assets/scenes", plan.arm, session.info.models);
    }
    if (plan.arm.urdf != session.info.device_urdf) {
      plan.start.reset();
      for (Lane& lane : plan.beside) lane.start.reset();
    }
    if (!plan.hand_torque.empty() && plan.arm.dof() != session.info.dof) {
      throw UsageError(
          fmt::format("--device: {} has {} joints; {} contains the hand's torque on {} joints",
                      options.device, plan.arm.dof(), options.hand, session.info.dof));
    }
  }
  if (!options.scene.empty()) {
    plan.document = read_scene(options.scene, plan.arm);
    if (plan.start) plan.start->world.clear();  // poses of another scene
    for (Lane& lane : plan.beside) {
      if (lane.start) lane.start->world.clear();
    }
  }
  if (!options.device.empty() || !options.scene.empty()) plan.models = build_meshes(plan.document);
  return plan;
}

// Varies the hand. Errors: UsageError for a hand that does more than follow a path.
void vary(RunPlan& plan, const InputOptions& options) {
  if (options.variation.value_or(0) == 0) return;
  const HandPath& hand = plan.hand;
  const bool held = std::ranges::all_of(hand.grip, [](double grip) { return grip == 1; });
  if (!held || !plan.hand_torque.empty() || !hand.magnet.empty() || !hand.pull.empty()) {
    throw UsageError(
        fmt::format("--variation: --hand {} contains more than a path: a released grip, torques, a "
                    "magnet or pulls have no variations; needed: only a path",
                    options.hand));
  }
  plan.hand = varied(plan.hand, plan.seed, *options.variation);
}

constexpr std::size_t kHelpWidth = 79;

// `text` in lines of at most `width` letters, each indented by `indent` spaces.
std::string in_lines(std::string_view text, std::size_t indent, std::size_t width) {
  std::string all, line;
  const auto end_line = [&] {
    if (!line.empty()) all += std::string(indent, ' ') + line + '\n';
    line.clear();
  };
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (count_characters(line) + 1 + count_characters(word) + indent > width) end_line();
    line += (line.empty() ? "" : " ") + std::string(word);
  }
  end_line();
  return all;
}

}  // namespace

void InputOptions::add_parameters(CLI::App& command) {
  command.add_option("--config", configs, "all parameters, from a TOML file")
      ->type_name("FILE.toml")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_option("--set", settings, "set one parameter; repeatable")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option("--coupling", coupling,
                  fmt::format("{} (coupling.kind)", fmt::join(kLawKeys, " or ")))
      ->type_name("KIND");
  command.add_option("--eta", eta, "impedance scaling (coupling.eta)")->type_name("RATIO");
  command.add_option("--alpha", alpha, "observer gain (observer.alpha)")->type_name("N_M_S/RAD");
}

std::function<std::string(std::string)> or_shipped(Kinds kinds) {
  return [kinds = std::move(kinds)](const std::string& named) {
    if (named.empty() || std::filesystem::exists(named)) return named;
    if (const auto own = shipped_file(named, kinds)) return own->string();
    // Ids of devices, without a dot, are not files.
    const std::string hint = named.find('.') != std::string::npos ? shipped_hint(named, kinds) : "";
    if (!hint.empty()) throw UsageError(named + ": no such file" + hint);
    return named;
  };
}

void InputOptions::add_arm(CLI::App& command) {
  command
      .add_option("--device", device,
                  "the arm; default: the built-in arm, like an Omni but ideal. "
                  "inverse3[:ID][@HOST[:PORT]]: in the window the Inverse3 of a Haply Inverse "
                  "Service, in other commands an arm like the Inverse3")
      ->transform(or_shipped({"devices"}), "", "")
      ->type_name("FILE.urdf");
  command
      .add_option("--tip", tip,
                  "the link of the arm that the hand holds; default: the end of the longest chain")
      ->type_name("LINK");
}

void InputOptions::add_world(CLI::App& command) {
  add_arm(command);
  command.add_option("--scene", scene, "what can be touched; default: a table")
      ->transform(or_shipped({"scenes"}), "", "")
      ->type_name("FILE.toml");
}

void InputOptions::add_readings(CLI::App& command) {
  command.add_flag(
      "--readings", readings,
      "use encoder steps and delay of the arm's file (touch.urdf has both); without this option "
      "encoders are exact and have no delay, unless settings say otherwise");
}

void InputOptions::add_hand(CLI::App& command) {
  command
      .add_option("--hand", hand,
                  "the hand's path, or a recorded session; default: touching the table")
      ->transform(or_shipped({"hands", "sessions"}), "", "")
      ->type_name("FILE.csv|FILE.h5");
  auto* length =
      command.add_option("--duration", duration, "default: the length of the hand's path")
          ->type_name("SECONDS");
  require_above_zero(length, kLongestRun, "s");
  command
      .add_option("--variation", variation,
                  "number of a small random variation of the hand's path, as if the same person "
                  "repeated the motion (like `repeats` of a sweep); default: 0, no variation")
      ->type_name("I")
      ->check(whole_number());
  command.add_option("--seed", seed, "the seed of the hand's variations; nothing else is random")
      ->type_name("N")
      ->check(whole_number());
}

InputOptions both(const InputOptions& first, InputOptions second) {
  const auto unless_said = [](auto& said, const auto& before) {
    if (said == std::decay_t<decltype(said)>{}) said = before;
  };
  unless_said(second.device, first.device);
  unless_said(second.tip, first.tip);
  unless_said(second.scene, first.scene);
  unless_said(second.hand, first.hand);
  unless_said(second.coupling, first.coupling);
  unless_said(second.eta, first.eta);
  unless_said(second.alpha, first.alpha);
  unless_said(second.duration, first.duration);
  unless_said(second.seed, first.seed);
  unless_said(second.variation, first.variation);
  second.configs.insert(second.configs.begin(), first.configs.begin(), first.configs.end());
  second.settings.insert(second.settings.begin(), first.settings.begin(), first.settings.end());
  return second;
}

Parameters make_parameters(const InputOptions& options, Parameters base) {
  for (const std::string& file : options.configs) apply_config(base, file);
  for (const std::string& setting : options.settings) apply_setting(base, setting);
  if (options.coupling) apply_setting(base, "coupling.kind=" + *options.coupling);
  if (options.eta) apply_setting(base, "coupling.eta=" + *options.eta);
  if (options.alpha) apply_setting(base, "observer.alpha=" + *options.alpha);
  return base;
}

Parameters make_parameters(const InputOptions& options, const ArmDescription& arm) {
  const Parameters asked = make_parameters(options);
  return make_parameters(options,
                         options.readings ? fitted_with_readings(arm, asked) : fitted(arm, asked));
}

std::string device_named(const std::string& words) {
  try {
    return DeviceHub::id_of(words);
  } catch (const std::exception& e) {
    throw UsageError(e.what());
  }
}

ArmDescription arm_of(const InputOptions& options) {
  std::string file = options.device;
  if (file.empty()) file = default_device().string();
  if (!device_named(file).empty()) file = DeviceHub::arm_file_of(file).string();
  if (!std::filesystem::exists(file)) {
    throw FileError(file + ": no such file" + shipped_hint(file, {"devices"}));
  }
  ArmDescription arm = read_urdf(file, options.tip, Xacro::expand);
  require_readings(options, arm);
  return arm;
}

void require_readings(const InputOptions& options, const ArmDescription& arm) {
  if (!options.readings || arm.encoder_step > 0 || arm.assumed_delay > 0 || arm.delay) return;
  throw UsageError(fmt::format(
      "--readings: the file of the arm {} has neither encoder steps nor a delay", arm.name));
}

void read_world(const InputOptions& options, ArmDescription& arm, SceneDocument& document) {
  arm = arm_of(options);
  const bool own = options.hand.empty() && !options.device.empty();
  std::filesystem::path scene = options.scene;
  if (options.scene.empty()) scene = own ? default_scene(arm) : default_scene();
  document = read_scene(scene, arm);
}

RunPlan make_plan(const InputOptions& options) {
  RunPlan plan;
  if (is_session(options.hand)) {
    if (options.readings) {
      throw UsageError(
          "--readings: not together with a recorded session, which has its own settings; change "
          "the settings with --set device.encoder_step and --set device.delay");
    }
    plan = plan_from_session(options);
  } else {
    read_world(options, plan.arm, plan.document);
    plan.models = build_meshes(plan.document);
    plan.parameters = make_parameters(options, plan.arm);
    if (options.hand.empty() && !options.device.empty() && !suits_default_world(plan.arm)) {
      SmallPath path = small_path(plan.arm);
      plan.hand = std::move(path.hand);
      plan.start = std::move(path.start);
    } else {
      plan.hand = read_hand(options.hand.empty() ? default_hand().string() : options.hand);
    }
  }
  if (options.seed) plan.seed = *options.seed;
  vary(plan, options);
  if (const std::string why = out_of_reach(plan); !why.empty()) throw UsageError(why);
  const double duration = options.duration.value_or(plan.hand.duration());
  plan.rows = ticks_in(duration, plan.parameters.tick);
  return plan;
}

void keep_apart(const char* option, const std::filesystem::path& out,
                std::span<const std::string> read) {
  for (const std::string& file : read) {
    std::error_code none;
    if (out.empty() || file.empty() || !std::filesystem::equivalent(out, file, none)) continue;
    throw UsageError(
        fmt::format("{} {}: the command reads this file; name another file", option, out.string()));
  }
}

void keep_apart(const char* option, const std::filesystem::path& out, const InputOptions& input) {
  std::vector<std::string> read = input.configs;
  read.insert(read.end(), {input.device, input.scene, input.hand});
  keep_apart(option, out, read);
}

void keep_outputs_apart(const char* one, const std::filesystem::path& out, const char* two,
                        const std::filesystem::path& other) {
  if (out.empty() || other.empty()) return;
  const auto whole = [](const std::filesystem::path& file) {
    std::error_code none;
    return std::filesystem::weakly_canonical(std::filesystem::absolute(file), none);
  };
  if (whole(out) != whole(other)) return;
  throw UsageError(
      fmt::format("{} {}: {} writes this file; name another file", two, other.string(), one));
}

std::string allowed_values(const FieldInfo& info) {
  if (!info.words.empty()) return fmt::format("{}", fmt::join(info.words, ", "));
  if (info.kind == FieldInfo::Kind::flag) return "true, false";
  const std::string unit = info.has_unit() ? std::string(" ") + info.unit : "";
  return fmt::format("{} to {}{}", info.minimum, info.maximum, unit);
}

std::string parameter_help() {
  std::string text =
      "Keys for --set and --config. For a joint that slides, 1 rad stands for 10 cm, and 1 N m for "
      "10 N:\n";
  for (const ParameterInfo& info : parameter_table()) {
    const std::string value = parameter_text(Parameters{}, info);
    const char* open =
        std::string_view(info.key).starts_with("device.") ? "the arm's" : "automatic";
    const std::string begin =
        fmt::format("  {:<20} default {:<11} ", info.key, value.empty() ? open : value);
    text += begin + in_lines(allowed_values(info), begin.size(), kHelpWidth).substr(begin.size());
    text += in_lines(info.meaning, 6, kHelpWidth);
  }
  return text;
}

void wrap_help(CLI::App& command) {
  constexpr std::size_t kColumn = 30;  // where CLI11 begins an option's description
  for (CLI::Option* option : command.get_options()) {
    std::string text = in_lines(option->get_description(), 0, kHelpWidth - kColumn);
    if (!text.empty()) text.pop_back();
    option->description(text);
  }
}

std::vector<HelpWord> parameter_words() {
  std::vector<HelpWord> words;
  for (const ParameterInfo& info : parameter_table()) {
    const std::string key = std::string(info.key) + "=";
    if (info.is_number()) words.push_back({key, allowed_values(info)});
    for (const char* word : info.words) words.push_back({key + word, ""});
    if (info.kind != FieldInfo::Kind::flag) continue;
    for (const char* word : {"true", "false"}) words.push_back({key + word, ""});
  }
  return words;
}

void require_whole_number(CLI::Option* option) { option->check(whole_number()); }

void require_above_zero(CLI::Option* option, double most, const std::string& unit) {
  const auto check = [=](const std::string& text) -> std::string {
    const auto x = number_in(text);
    if (x && *x > 0 && *x <= most) return {};
    return fmt::format("\"{}\" is not allowed; allowed: a number above 0, up to {} {}", text, most,
                       unit);
  };
  option->check(check);
}

void refuse_empty_values(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    if (option->get_items_expected_max() == 0) continue;
    option->check([](const std::string& text) {
      return std::string(text.empty() ? "\"\" is not allowed; allowed: a value" : "");
    });
  }
}

}  // namespace limpid
