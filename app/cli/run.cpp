#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <optional>

#include "app/base/interrupt.h"
#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/cli/picture.h"
#include "app/cli/progress.h"
#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "app/run/summary.h"

namespace limpid {
namespace {

using Seconds = std::chrono::duration<double>;

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
    throw std::runtime_error(
        fmt::format("{}; what was recorded up to there is in {}.part (limpid recover)", e.what(),
                    recorder.out().string()));
  }
}

// Before the run, so that it is not made for nothing.
void check_picture(const std::filesystem::path& png) {
  const auto refuse = [&](int code) {
    throw UsageError(fmt::format("--picture {}: {}", png.string(), std::strerror(code)));
  };
  const std::filesystem::path folder = png.has_parent_path() ? png.parent_path() : ".";
  if (std::filesystem::is_directory(png)) refuse(EISDIR);
  if (access((folder / ".").c_str(), W_OK | X_OK) != 0) refuse(errno);
}

int run(const RunOptions& options) {
  const RunPlan plan = make_plan(options.input);
  if (!options.picture.empty()) check_picture(options.picture);
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
    Progress progress({.title = "run",
                       .whole = static_cast<double>(plan.rows) * plan.parameters.tick,
                       .unit = "s",
                       .rate = "times real time"});
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
    fmt::print(
        stderr,
        "limpid: unstable from t = {:.3f} s on: {}; try a larger eta, a smaller alpha or k_vc "
        "(`limpid analyze` shows the limits)\n",
        end.diverged_at, end.why);
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
