#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <filesystem>
#include <optional>
#include <span>

#include "app/base/interrupt.h"
#include "app/cli/commands.h"
#include "app/cli/live_bench.h"
#include "app/cli/measured_text.h"
#include "app/cli/options.h"
#include "app/cli/progress.h"
#include "app/cli/still_picture.h"
#include "app/cli/summary_json.h"
#include "app/run/fitted_gains.h"
#include "app/run/lane_settings.h"
#include "app/run/provenance.h"
#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "app/run/run_notes.h"
#include "app/run/run_watch.h"
#include "app/run/simulate.h"
#include "app/run/summary.h"
#include "devices/files/atomic_file.h"
#include "devices/files/config_file.h"
#include "devices/files/session/session.h"
#include "devices/identify/grip_probe.h"

namespace limpid {
namespace {

constexpr double kLiveSeconds = 10;  // of --live without --duration [s]

struct LiveRunOptions {
  LiveOptions live;
  InputOptions input;
  std::string record, picture;
  bool force = false, measure_grip = false;
};

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) fmt::print(stderr, "limpid: warning: {}\n", warning);
}

// The hand that was measured in a run.
MeasuredHand measured(const RunPlan& plan, const GripRecord& record) {
  return judged(plan.arm, plan.parameters, plan.document.scene,
                find_grip(plan.arm, plan.parameters, record));
}

[[noreturn]] void refuse_short_grip() {
  throw UsageError(
      fmt::format("--measure-grip: give --duration of at least {:.4g} s", grip_run_duration()));
}

// Takes a hand that holds the tip at the path's beginning, as long as measuring its grip takes.
void hold_still(RunPlan& plan, const InputOptions& input) {
  plan.hand = hand_through({0}, {plan.hand.position.front()}, "hand that holds still");
  const double seconds = input.duration.value_or(grip_run_duration());
  plan.rows = ticks_in(seconds, plan.parameters.tick);
}

int run_live(const LiveRunOptions& options) {
  LiveBench bench(options.live, options.input);
  const RunPlan& plan = bench.plan();
  Summary summary(plan.layout(), plan.arm);
  RunWatch watch(plan.arm, plan.layout(), plan.parameters);
  const double seconds = options.input.duration.value_or(kLiveSeconds);
  if (options.measure_grip && seconds < grip_run_duration()) refuse_short_grip();
  LiveTask task{
      fmt::format("Take hold of {} and move it for {:.3g} s, as you like.", plan.arm.name, seconds),
      seconds, options.record, options.force};
  if (options.measure_grip) {
    task.instruction = fmt::format(
        "Hold {} still, away from walls, with the grip that you will use, for {:.3g} s.",
        plan.arm.name, seconds);
    task.measure_grip = true;
  }
  GripRecord grip(plan.layout(), plan.parameters.tick);
  const bool whole = bench.carry_out(task, plan.parameters, [&](std::span<const double> row) {
    summary.add(row);
    watch.add(row);
    grip.take(row);
  });
  if (summary.totals().rows == 0) {
    fmt::print(stderr, "limpid: stopped\n");
    return 1;
  }
  if (!options.picture.empty()) save_picture(options.picture, plan, summary.memorable());
  fmt::print("{}{}", summary.text(), at_limit_text(std::array{watch.at_limit()}));
  if (options.measure_grip) print_measured(measured(plan, grip));
  if (!options.record.empty()) {
    fmt::print("recorded {} ticks in {}\n", summary.totals().rows, options.record);
  }
  print_warnings(watch.cautions());
  if (whole) return 0;
  fmt::print(stderr, "limpid: stopped at {:.3f} s\n", summary.time());
  return 1;
}

using Seconds = std::chrono::duration<double>;

struct RunOptions {
  InputOptions input;
  std::string record;
  std::string picture;
  bool force = false;
  bool realtime = false, json = false, measure_grip = false;
  // Settings of each further lane, as key=value; nothing: there is no such lane.
  std::array<std::optional<std::vector<std::string>>, kMostLanes - 1> beside;
  LiveOptions live;
};

// Finishes the recording; from here on errors are a failed run, not bad input.
void finish(Recorder& recorder) {
  try {
    recorder.finish();
  } catch (const FileError& e) {
    throw std::runtime_error(
        fmt::format("{}; the recording up to that moment is in {}.part (limpid recover)", e.what(),
                    recorder.out().string()));
  }
}

// Checks outputs before the run, so that it is not made in vain.
void check_outputs(const RunOptions& options) {
  keep_apart("--record", options.record, options.input);
  const std::filesystem::path png = options.picture;
  if (!png.empty()) {
    keep_apart("--picture", png, options.input);
    keep_outputs_apart("--record", options.record, "--picture", png);
  }
  if (!options.record.empty()) check_ending(options.record, kSessionEnding);
  if (png.empty()) return;
  const auto refuse = [&](int code) {
    throw UsageError(fmt::format("--picture {}: {}", png.string(), std::strerror(code)));
  };
  const std::filesystem::path folder = png.has_parent_path() ? png.parent_path() : ".";
  if (std::filesystem::is_directory(png)) refuse(EISDIR);
  check_ending(png, ".png");
  if (access((folder / ".").c_str(), W_OK | X_OK) != 0) refuse(errno);
  if (!options.force && std::filesystem::exists(png)) {
    throw UsageError(
        fmt::format("--picture {}: exists already; --force replaces it", png.string()));
  }
}

// A word or two that tell two runs on one hand apart.
std::string short_name(const Parameters& p) {
  return fmt::format("{} {:.3g}", name(p.kind), p.eta);
}

std::string lane_option(std::size_t lane) { return "--" + lane_name(lane); }

// Adds further lanes to a plan: with the given settings, else with a law that no lane has yet.
void add_lanes(const RunOptions& options, RunPlan& plan) {
  bool last = false;
  for (std::size_t lane = 1; lane < kMostLanes; ++lane) {
    const auto& settings = options.beside[lane - 1];
    if (settings && last) {
      throw UsageError(
          fmt::format("{}: needs {} as well", lane_option(lane), lane_option(lane - 1)));
    }
    last = !settings;
    if (!settings) continue;
    Lane added{plan.parameters, {}};
    for (const std::string& setting : *settings) {
      check_of_one_lane(key_of_setting(setting), "set it for the first run");
      apply_setting(added.parameters, setting);
    }
    if (settings->empty()) added.parameters.kind = law_beside(plan.settings());
    plan.beside.push_back(std::move(added));
  }
}

// Takes the ticks as they come.
class RunLog {
 public:
  RunLog(const RunPlan& plan, Recorder* recorder, bool waits)
      : stride_(static_cast<std::size_t>(plan.layout().stride())),
        runs_(plan.lanes(), Summary(plan.layout(), plan.arm)),
        grip_(plan.layout(), plan.parameters.tick),
        recorder_(recorder),
        waits_(waits) {
    for (std::size_t i = 0; i < plan.lanes(); ++i) {
      watches_.emplace_back(plan.arm, plan.layout(), plan.lane(i).parameters);
    }
  }

  // Returns false to end the run.
  bool take(std::span<const double> rows, LaneChanges changed) {
    for (std::size_t lane = 0; lane < runs_.size(); ++lane) {
      if (changed[lane] != nullptr) watches_[lane].change(rows_, *changed[lane]);
      watches_[lane].add(rows.subspan(lane * stride_, stride_));
    }
    ++rows_;
    const bool was_wild = runs_[0].watch().wild();
    const bool memorable = runs_[0].add(rows.first(stride_));
    grip_.take(rows.first(stride_));
    if (runs_[0].watch().wild() && !was_wild) stable_ = memorable_;
    for (std::size_t lane = 1; lane < runs_.size(); ++lane) {
      runs_[lane].add(rows.subspan(lane * stride_, stride_));
    }
    if (memorable) memorable_.assign(rows.begin(), rows.end());
    if (recorder_ == nullptr) return true;
    for (std::size_t lane = 0; lane < runs_.size(); ++lane) {
      if (changed[lane] != nullptr) recorder_->changed(*changed[lane], lane);
    }
    if (waits_) return recorder_->push_waiting(rows);
    recorder_->push(rows);
    return !recorder_->failed();
  }

  nlohmann::ordered_json json() const {
    std::vector<std::string> warnings;
    for (std::size_t lane = 0; lane < runs_.size(); ++lane) {
      add_warnings(watches_[lane].warnings(), lane, warnings);
    }
    return runs_json(summaries(), warnings, at_limit());
  }
  // Warnings besides that of an unstable run.
  std::vector<std::string> cautions() const {
    std::vector<std::string> all;
    for (std::size_t lane = 0; lane < watches_.size(); ++lane) {
      add_warnings(watches_[lane].cautions(), lane, all);
    }
    return all;
  }
  double time() const { return runs_[0].time(); }
  const GripRecord& grip() const { return grip_; }  // as far as it was measured
  // Rows of all lanes when the first one's contact was strongest; of a run that became unstable,
  // before that.
  std::span<const double> memorable() const {
    return runs_[0].watch().lost() && !stable_.empty() ? stable_ : memorable_;
  }
  std::string text(const RunPlan& plan) const {
    const std::string limits = at_limit_text(at_limit());
    if (plan.beside.empty()) return runs_[0].text() + limits;
    std::vector<std::string> names;
    for (const Parameters& p : plan.settings()) names.push_back(short_name(p));
    return Summary::beside(summaries(), names) + limits;
  }

 private:
  std::vector<double> at_limit() const {
    std::vector<double> all;
    for (const RunWatch& watch : watches_) all.push_back(watch.at_limit());
    return all;
  }
  std::vector<const Summary*> summaries() const {
    std::vector<const Summary*> all;
    for (const Summary& run : runs_) all.push_back(&run);
    return all;
  }

  std::size_t stride_;
  std::vector<Summary> runs_;
  std::deque<RunWatch> watches_;
  std::uint64_t rows_ = 0;
  GripRecord grip_;
  std::vector<double> memorable_, stable_;  // stable_: before the present wild rows began
  Recorder* recorder_;
  bool waits_;
};

RunEnd carry_out(const RunOptions& options, const RunPlan& plan, RunLog& log) {
  Progress progress({.title = "run",
                     .whole = static_cast<double>(plan.rows) * plan.parameters.tick,
                     .unit = "s",
                     .rate = "times real time"});
  return simulate(plan, {options.realtime, &interrupted},
                  [&](std::span<const double> rows, LaneChanges changed) {
                    const bool goes_on = log.take(rows, changed);
                    progress.at(log.time());
                    return goes_on;
                  });
}

int report(const RunOptions& options, const RunEnd& end, const Recorder* recorder,
           const RunLog& log) {
  if (recorder != nullptr) {
    if (!options.json) fmt::print("recorded {} ticks in {}\n", recorder->rows(), options.record);
    if (recorder->dropped() > 0) {
      fmt::print(stderr, "limpid: {} ticks are missing from {}: the disk was too slow\n",
                 recorder->dropped(), options.record);
      return 1;
    }
  }
  if (end.diverged) {  // which explains all other warnings
    fmt::print(stderr,
               "limpid: unstable since t = {:.3f} s: {}; try a larger eta, a smaller alpha or k_vc "
               "(`limpid analyze` shows the limits)\n",
               end.diverged_at, end.why);
    return 1;
  }
  print_warnings(log.cautions());
  if (!end.stopped) return 0;
  fmt::print(stderr, "limpid: stopped at {:.3f} s\n", log.time());
  return 1;
}

// Prints notes on guesses about the arm and parameters fitted to it.
void say_about(const RunPlan& plan) {
  if (!plan.note.empty()) fmt::print(stderr, "limpid: note: {}\n", plan.note);
  for (const std::string& warning : plan.arm.warnings) {
    fmt::print(stderr, "limpid: warning: {}\n", warning);
  }
  for (const std::string& note : notes_on(plan.arm, plan.parameters)) {
    fmt::print(stderr, "limpid: note: {}\n", note);
  }
  const bool again = plan.hand.tick > 0;  // a recording has its own settings
  const std::string fit = again ? "" : fit_text(fitted(plan.arm, plan.parameters));
  if (!fit.empty()) {
    fmt::print(stderr, "limpid: gains fitted to the arm, except those that are set: {}\n", fit);
  }
  if (const std::string filed = readings_text(plan.arm, plan.parameters);
      !again && !filed.empty()) {
    fmt::print(stderr, "limpid: note: {}: {}; --readings takes the values of the arm's file\n",
               plan.arm.name, filed);
  }
}

int live(const RunOptions& options) {
  const auto refuse = [](bool given, std::string_view what) {
    if (given)
      throw UsageError(
          fmt::format("{}: not together with --live: your own hand moves the device", what));
  };
  refuse(!options.input.hand.empty(), "--hand");
  refuse(options.input.variation.has_value(), "--variation");
  if (options.input.readings)
    throw UsageError(
        "--readings: not together with --live: the device has its own encoder step and delay");
  for (std::size_t lane = 1; lane < kMostLanes; ++lane) {
    refuse(options.beside[lane - 1].has_value(), lane_option(lane));
  }
  if (options.json) throw UsageError("--json: not together with --live");
  check_outputs(options);
  return run_live({options.live, options.input, options.record, options.picture, options.force,
                   options.measure_grip});
}

void print_json(const RunOptions& options, const RunPlan& plan, const RunLog& log) {
  nlohmann::ordered_json json{
      {"provenance", provenance(settings_digest(plan.parameters), plan.seed)}};
  json.update(log.json());
  if (options.measure_grip) json["measured_grip"] = measured_json(measured(plan, log.grip()));
  json["recorded"] = nullptr;
  if (!options.record.empty()) json["recorded"] = options.record;
  fmt::print("{}\n", json.dump(2));
}

int run(const RunOptions& options) {
  if (options.live.device) return live(options);
  RunPlan plan = make_plan(options.input);
  if (options.measure_grip && options.input.hand.empty()) hold_still(plan, options.input);
  if (options.measure_grip && !measure_grip(plan)) refuse_short_grip();
  say_about(plan);
  options.live.say_unused();
  if (options.input.seed && options.input.variation.value_or(0) == 0) {
    fmt::print(stderr,
               "limpid: note: --seed changes nothing here: only variations of the hand are random, "
               "and --variation is 0 or not given\n");
  }
  if (options.beside[0]) plan.beside.clear();  // those of a recording
  add_lanes(options, plan);
  check_outputs(options);
  catch_interrupts();
  std::optional<Recorder> recorder;
  if (!options.record.empty()) {
    recorder.emplace(options.record, session_info(plan), plan.settings(), options.force,
                     options.realtime ? Recorder::kLiveRoom : Recorder::kWaitingRoom);
    tell_start(*recorder, plan);
    if (const std::string note = lock_note(*recorder); !note.empty()) {
      fmt::print(stderr, "limpid: note: {}\n", note);
    }
  }
  RunLog log(plan, recorder ? &*recorder : nullptr, !options.realtime);
  const auto began = std::chrono::steady_clock::now();
  const RunEnd end = carry_out(options, plan, log);
  const double took = Seconds(std::chrono::steady_clock::now() - began).count();
  if (recorder) finish(*recorder);
  if (!options.picture.empty()) save_picture(options.picture, plan, log.memorable());
  if (options.json) {
    print_json(options, plan, log);
    return report(options, end, recorder ? &*recorder : nullptr, log);
  }
  fmt::print("{}", log.text(plan));
  if (options.measure_grip) print_measured(measured(plan, log.grip()));
  const double simulated = static_cast<double>(end.rows) * plan.parameters.tick;
  fmt::print("{:.3f} s in {:.3f} s, {} times real time\n", simulated, took,
             rate_text(simulated / took));
  return report(options, end, recorder ? &*recorder : nullptr, log);
}

}  // namespace

Command declare_run(CLI::App& app) {
  auto* command = app.add_subcommand(
      "run", "runs the window's control loop without a window, as fast as possible");
  auto options = std::make_shared<RunOptions>();
  command->add_option("--record", options->record, "write every tick to this session file")
      ->type_name("OUT.h5");
  command
      ->add_option("--picture", options->picture,
                   "draw a picture of the strongest contact into this file")
      ->type_name("OUT.png");
  command->add_flag("--force", options->force, "replace OUT.h5 and OUT.png if they exist");
  command->add_flag("--json", options->json,
                    "print the results as one JSON object, instead of lines");
  command->add_flag("--realtime", options->realtime, "run in real time, at the tick rate");
  command->add_flag(
      "--measure-grip", options->measure_grip,
      fmt::format("measure how the hand holds the device: for {:.3g} s the motors "
                  "add a small force; prints stiffness, damping and mass of the hand "
                  "with their bounds, and eta_min and the walls that are stable in this hand. "
                  "The run takes at least {:.4g} s",
                  GripProbe::kDuration, grip_run_duration()));
  for (std::size_t lane = 1; lane < kMostLanes; ++lane) {
    command
        ->add_option_function<std::vector<std::string>>(
            lane_option(lane),
            [options, lane](const auto& settings) {
              options->beside[lane - 1] = settings;
              std::erase(*options->beside[lane - 1], "");  // from the option alone
            },
            fmt::format("a {} run at the same time, with the same hand; it has the standard "
                        "coupling (another law if a run has the standard coupling already), or "
                        "these changed settings; settings of hand, device and loop are the same "
                        "for all runs",
                        lane_ordinal(lane)))
        ->type_name("[KEY=VALUE ...]")
        ->expected(0, -1)
        ->trigger_on_parse(false);
  }
  options->live.add(*command);
  options->input.add_world(*command);
  options->input.add_readings(*command);
  options->input.add_hand(*command);
  options->input.add_parameters(*command);
  command->footer(
      "FILE.csv has a header time_s,x_m,y_m,z_m[,...] and a row for each moment. A session "
      "contains\nits own device, scene and parameters; options override these.\n\n" +
      parameter_help());
  return [options] { return run(*options); };
}

}  // namespace limpid
