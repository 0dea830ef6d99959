#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

#include "app/base/interrupt.h"
#include "app/cli/commands.h"
#include "app/cli/live_bench.h"
#include "app/cli/options.h"
#include "app/cli/out_folder.h"
#include "app/cli/outcome_text.h"
#include "app/cli/progress.h"
#include "app/experiments/live.h"
#include "core/realtime/realtime.h"
#include "devices/files/config_file.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/toml_reader.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kMostThreads = 256;

struct ExperimentOptions {
  std::string name;
  std::string out;
  std::optional<std::uint64_t> seed;
  std::optional<unsigned> threads;
  bool force = false;
  LiveOptions live;
  InputOptions input;  // for live experiments
};

// Finds the experiment of that name, or all.
template <class E>
std::vector<const E*> chosen(std::span<const E> known, const std::string& name,
                             const char* refusal) {
  std::vector<const E*> wanted;
  std::string names = "all";
  std::vector<std::string> known_names;
  for (const E& e : known) {
    if (name == "all" || name == e.name) wanted.push_back(&e);
    names += fmt::format(", {}", e.name);
    known_names.emplace_back(e.name);
  }
  if (!wanted.empty()) return wanted;
  const auto meant = nearest(name, known_names);
  throw UsageError(fmt::format("\"{}\"{}; {}allowed: {}", name, refusal,
                               meant ? fmt::format("did you mean {}? ", *meant) : "", names));
}

Outcome carry_out_with_progress(const Experiment& experiment, const ExperimentArm& on,
                                const ExperimentOptions& options, std::size_t index,
                                std::size_t count) {
  Progress progress({.title = fmt::format("{} ({} of {})", experiment.name, index + 1, count),
                     .whole = 100,
                     .unit = "",
                     .rate = "% per second"});
  return carry_out(experiment, {.dir = options.out,
                                .seed = options.seed.value_or(0),
                                .threads = options.threads.value_or(0),
                                .arm = on,
                                .stop = &interrupted,
                                .progress = [&](double part) { progress.at(100 * part); }});
}

// Gains that no experiment varies.
constexpr std::array kGains{"coupling.k_vc", "coupling.b_vc", "coupling.b_v"};

bool sets_a_gain(const std::string& setting) {
  return std::ranges::count(kGains, key_of_setting(setting)) > 0;
}

// Refuses options of scene and settings: an experiment has its own.
void refuse_what_has_no_effect(const InputOptions& input) {
  for (const auto& [given, option] : {std::pair(!input.scene.empty(), "--scene"),
                                      {!input.configs.empty(), "--config"},
                                      {!std::ranges::all_of(input.settings, sets_a_gain), "--set"},
                                      {input.coupling.has_value(), "--coupling"},
                                      {input.eta.has_value(), "--eta"},
                                      {input.alpha.has_value(), "--alpha"}}) {
    if (!given) continue;
    throw UsageError(
        fmt::format("{}: only together with --live; this experiment has its own scene and settings "
                    "(`limpid run` and `limpid sweep` accept your own). --set may change {}",
                    option, fmt::join(kGains, ", ")));
  }
}

// The arm of the options, with the settings that `limpid run` gives it.
ExperimentArm arm_under(const InputOptions& input) {
  const bool given = !input.device.empty() || !input.tip.empty();
  const ArmDescription arm = given ? arm_of(input) : built_in_arm().description;
  require_readings(input, arm);
  ExperimentArm on = experiment_arm(arm, input.readings);
  if (input.settings.empty()) return on;
  on.settings = make_parameters(input, arm);
  on.name = fmt::format("{}{}{}", arm.name, on.readings ? " with its readings and " : " with ",
                        fmt::join(input.settings, " and "));
  return on;
}

// Takes away experiments that do not run on the arm, and says why. Errors: UsageError if none is
// left.
void keep_those_for(const ExperimentArm& on, std::vector<const Experiment*>& wanted) {
  std::vector<std::string> refused;
  std::erase_if(wanted, [&](const Experiment* one) {
    const std::string why = why_not(*one, on);
    if (!why.empty()) refused.push_back(why);
    return !why.empty();
  });
  if (wanted.empty()) throw UsageError(refused.front());
  for (const std::string& why : refused) fmt::print(stderr, "limpid: not run: {}\n", why);
}

std::string name_of(const Experiment& experiment) { return experiment.name; }
std::string name_of(const LiveExperiment& experiment) { return live_name(experiment); }

// Names of the files that these experiments write.
template <class E>
std::vector<std::string> files_of(const std::vector<const E*>& wanted) {
  std::vector<std::string> names{"report"};
  for (const E* one : wanted) names.push_back(name_of(*one));
  return names;
}

int run(const ExperimentOptions& options) {
  refuse_what_has_no_effect(options.input);
  options.live.say_unused();
  auto wanted = chosen(experiments(), options.name, " is not an experiment");
  const ExperimentArm on = arm_under(options.input);
  keep_those_for(on, wanted);
  claim_out({options.out, "limpid experiment", files_of(wanted), options.force});
  catch_interrupts();
  keep_what_is_freed();
  std::vector<std::string> failed;  // checks
  try {
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      try {
        const Outcome outcome = carry_out_with_progress(*wanted[i], on, options, i, wanted.size());
        print_outcome(wanted[i]->name, outcome);
        note_failures(wanted[i]->name, outcome, failed);
        write_report(options.out);
      } catch (const OutOfReach& e) {
        if (wanted.size() == 1) throw;
        fmt::print(stderr, "limpid: not run: {}\n", e.what());
      }
    }
  } catch (const Cancelled&) {
    fmt::print(stderr, "limpid: stopped; the same command continues from here\n");
    return 1;
  } catch (const FileError& e) {  // of the results, not of the input
    throw std::runtime_error(e.what());
  }
  return finish_report(options.out, failed);
}

// Refuses a folder with trials of an earlier person, which this person's would replace. Errors:
// UsageError.
void keep_trials(const std::vector<const LiveExperiment*>& wanted,
                 const ExperimentOptions& options) {
  if (options.force) return;
  for (const LiveExperiment* one : wanted) {
    const fs::path trials = fs::path(options.out) / live_name(*one);
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(trials, none)) {
      if (entry.path().extension() != ".h5") continue;
      throw UsageError(
          fmt::format("--out {}: {} is a trial of an earlier session; choose another folder, or "
                      "use --force to replace the trials",
                      options.out, entry.path().string()));
    }
  }
}

// Functions that lead the hand through a trial of a live experiment, recorded in `folder`.
LiveLaboratory laboratory_of(LiveBench& bench, const fs::path& folder) {
  LiveLaboratory lab{bench.plan().arm, bench.plan().document, bench.plan().parameters, {}, {}};
  lab.parameters.per_joint = false;  // what is expected is of gains of all joints alike
  lab.run = [&bench, folder](const LiveTrial& trial) {
    fs::create_directories(folder);
    const LiveTask task{trial.instruction, trial.seconds, folder / (trial.name + ".h5"), true};
    if (!bench.carry_out(task, trial.parameters)) throw Cancelled();
    return read_session(task.out);
  };
  lab.stiffen = [&bench](double stiffness) {
    SceneDocument document = bench.plan().document;
    set_surface_stiffness(document.scene, stiffness);
    document.toml = scene_text(document, bench.plan().arm);
    bench.touch(document);
  };
  return lab;
}

int run_on_device(const ExperimentOptions& options) {
  if (options.input.readings) {
    throw UsageError("--readings: not together with --live: a device has its own readings");
  }
  for (const auto& [option, given] : {std::pair{"--seed", options.seed.has_value()},
                                      {"--threads", options.threads.has_value()}}) {
    if (given) throw UsageError(fmt::format("{}: not together with --live", option));
  }
  const auto wanted = chosen(live_experiments(), options.name, ": not together with --live");
  keep_trials(wanted, options);
  LiveBench bench(options.live, options.input);
  claim_out({options.out, "limpid experiment", files_of(wanted), options.force});
  std::vector<std::string> failed;  // checks
  try {
    for (const LiveExperiment* one : wanted) {
      LiveLaboratory lab = laboratory_of(bench, fs::path(options.out) / live_name(*one));
      const Outcome outcome = carry_out(*one, lab, options.out);
      print_outcome(live_name(*one), outcome);
      note_failures(live_name(*one), outcome, failed);
      write_report(options.out);
    }
  } catch (const Cancelled&) {
    fmt::print(stderr, "limpid: stopped\n");
    return 1;
  }
  return finish_report(options.out, failed);
}

std::string experiment_help() {
  std::string text = "Experiments:\n";
  for (const Experiment& e : experiments()) text += fmt::format("  {:<14} {}\n", e.name, e.about);
  text +=
      "  all            all experiments, one after the other\n\nWith --live, on a device in your "
      "hand:\n";
  for (const LiveExperiment& e : live_experiments()) {
    text += fmt::format("  {:<14} {}\n", e.name, e.about);
  }
  return text +
         "\nWrites DIR/NAME.csv, .png, .svg and .json, DIR/report.html and the sessions of\nthe "
         "trials. Called again with the same DIR, the command continues where it was "
         "stopped;\ntrials made by another version of the program, or with other inputs, are run "
         "again.\nWith --device an experiment runs on that arm, with gains that suit this arm; "
         "--set changes coupling.k_vc,\ncoupling.b_vc and coupling.b_v. --readings adds encoder "
         "steps and delay of the arm's file. Bounds are\npromised only for the built-in arm: on "
         "another arm the values are measured, but not judged. Each\nexperiment has its own scene "
         "and settings; options for these need --live.\nExit status 1: a check failed, or the "
         "command was stopped.";
}

}  // namespace

Command declare_experiment(CLI::App& app) {
  auto* command = app.add_subcommand(
      "experiment", "runs one of the paper's experiments: writes data, a figure and a verdict");
  auto options = std::make_shared<ExperimentOptions>();
  command->add_option("NAME", options->name, "an experiment, or all")->required();
  command->add_option("--out", options->out, "the folder for the results")
      ->required()
      ->type_name("DIR");
  add_force(*command, options->force);
  require_whole_number(
      command->add_option("--seed", options->seed, "the seed of all random numbers")
          ->type_name("N"));
  command->add_option("--threads", options->threads, "default: one per core")
      ->type_name("N")
      ->check(CLI::Range(1u, kMostThreads));
  options->live.add(*command);
  options->input.add_world(*command);
  options->input.add_readings(*command);
  options->input.add_parameters(*command);
  command->footer(experiment_help());
  return [options] { return options->live.device ? run_on_device(*options) : run(*options); };
}

}  // namespace limpid
