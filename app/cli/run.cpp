#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/cli/picture.h"
#include "app/interrupt.h"
#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "app/run/summary.h"

namespace limpid {
namespace {

using Seconds = std::chrono::duration<double>;

// "12.3 of 30.0 s simulated, 4 s left" on a terminal, once a run takes over a second. Printed by a
// thread of its own, so that no tick waits for a terminal.
class Progress {
 public:
  explicit Progress(double whole) : whole_(whole) {
    if (isatty(STDERR_FILENO) != 0) thread_ = std::jthread([this](auto stop) { show(stop); });
  }

  void at(double time) { time_.store(time, std::memory_order_relaxed); }

 private:
  void show(const std::stop_token& stop) const {
    using namespace std::chrono_literals;
    const auto began = std::chrono::steady_clock::now();
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any over;
    const auto over_within = [&](Seconds time) {
      over.wait_for(lock, stop, time, [] { return false; });
      return stop.stop_requested();
    };
    if (over_within(1s)) return;
    do {
      const double time = time_.load(std::memory_order_relaxed);
      const double elapsed = Seconds(std::chrono::steady_clock::now() - began).count();
      const double left = time > 0 ? elapsed * (whole_ - time) / time : 0;
      fmt::print(stderr, "\r{:.1f} of {:.1f} s simulated, {:.0f} s left ", time, whole_, left);
      std::fflush(stderr);
    } while (!over_within(200ms));
    fmt::print(stderr, "\r{:60}\r", "");
  }

  double whole_;
  std::atomic<double> time_{0};
  std::jthread thread_;
};

struct RunOptions {
  InputOptions input;
  std::string record;
  std::string picture;
  bool force = false;
  bool realtime = false;
};

// What goes wrong from here on is a failed run, no bad input.
void finish(Recorder& recorder) {
  try {
    recorder.finish();
  } catch (const FileError& e) {
    throw std::runtime_error(e.what());
  }
}

int run(const RunOptions& options) {
  const RunPlan plan = make_plan(options.input);
  catch_interrupts();
  std::optional<Recorder> recorder;
  if (!options.record.empty()) {
    recorder.emplace(options.record, session_info(plan), plan.parameters, options.force,
                     options.realtime ? Recorder::kLiveRoom : Recorder::kWaitingRoom);
  }

  Summary summary(RowLayout(plan.arm.dof()));
  const auto began = std::chrono::steady_clock::now();
  RunEnd end;
  {
    Progress progress(static_cast<double>(plan.rows) * plan.parameters.tick);
    end = simulate(plan, {options.realtime, &interrupted},
                   [&](std::span<const double> row, const Parameters* changed) {
                     summary.add(row);
                     progress.at(summary.time());
                     if (!recorder) return true;
                     if (changed != nullptr) recorder->changed(*changed);
                     if (!options.realtime) return recorder->push_waiting(row);
                     recorder->push(row);
                     return !recorder->failed();
                   });
  }
  const double took = Seconds(std::chrono::steady_clock::now() - began).count();
  if (recorder) finish(*recorder);
  if (!options.picture.empty()) {
    save_picture(options.picture, plan, summary.memorable());
  }

  fmt::print("{}", summary.text());
  const double simulated = static_cast<double>(end.rows) * plan.parameters.tick;
  fmt::print("{:.3f} s in {:.3f} s, {:.0f} times real time\n", simulated, took, simulated / took);
  if (recorder) {
    fmt::print("recorded {} ticks in {}\n", recorder->rows(), options.record);
    if (recorder->dropped() > 0) {
      fmt::print(stderr, "limpid: {} ticks found no room and are missing from {}\n",
                 recorder->dropped(), options.record);
      return 1;
    }
  }
  if (end.diverged) {
    fmt::print(stderr,
               "limpid: the loop became unstable and was stopped at {:.3f} s; try a larger eta, a "
               "smaller alpha or k_vc (`limpid analyze` shows the limits)\n",
               summary.time());
    return 1;
  }
  if (end.stopped) fmt::print(stderr, "limpid: stopped at {:.3f} s\n", summary.time());
  return 0;
}

}  // namespace

Command declare_run(CLI::App& app) {
  auto* command = app.add_subcommand("run", "the same loop without a window, as fast as it goes");
  auto options = std::make_shared<RunOptions>();
  command->add_option("--record", options->record, "write every tick to this session file")
      ->type_name("OUT.h5");
  command
      ->add_option("--picture", options->picture,
                   "draw the moment of the strongest contact into this file")
      ->type_name("OUT.png");
  command->add_flag("--force", options->force, "replace OUT.h5 if it exists");
  command->add_flag("--realtime", options->realtime, "pace at the tick rate");
  options->input.add_world(*command);
  options->input.add_hand(*command);
  options->input.add_parameters(*command);
  command->footer(
      "FILE.csv holds a header time_s,x_m,y_m,z_m[,...] and a row for each moment. A session "
      "brings\nits own device, scene and parameters; options override them.\n\n" +
      parameter_help());
  return [options] { return run(*options); };
}

}  // namespace limpid
