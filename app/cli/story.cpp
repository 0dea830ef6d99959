#include "app/story/story.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <span>
#include <stdexcept>

#include "app/base/interrupt.h"
#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/cli/progress.h"
#include "app/run/run_watch.h"
#include "app/story/run_story.h"
#include "devices/files/atomic_file.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_units.h"

namespace limpid {
namespace {

struct StoryOptions {
  std::string script;
  std::string record;
  bool check = false;
  VideoOptions video;
};

void print_steps(const Story& story) {
  for (const StoryStep& step : story.steps) {
    fmt::print("{:5.1f} to {:5.1f} s  {}\n", step.begins, step.ends, step.caption);
  }
}

void print_numbers(const Story& story, const Session& session) {
  const auto all = measure(story.steps, session);
  const NormUnits units = norm_units(slides_of(story.plan.arm));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const StoryStep& step = story.steps[i];
    fmt::print("{:.1f} to {:.1f} s  {}\n", step.begins, step.ends, step.caption);
    std::size_t width = 0;
    for (const std::string& name : step.names) width = std::max(width, name.size());
    for (std::size_t lane = 0; lane < all[i].size(); ++lane) {
      const StepNumbers& n = all[i][lane];
      fmt::print(
          "    {:{}}  |x_E| up to {:.4g} {}, |f1| {:.4g} {} rms, |f2| up to {:.4g} {}, E_c rises "
          "by "
          "{:.4g} mJ\n",
          step.names[lane], width, 1e3 * units.angles * n.largest_error, units.milliangle,
          units.torques * n.rms_human, units.torque, units.torques * n.largest_contact,
          units.torque, 1e3 * n.energy_given);
    }
  }
}

StoryRun tell_with_progress(const Story& story) {
  catch_interrupts();
  Progress progress(
      {.title = "story", .whole = story.seconds(), .unit = "s", .rate = "times real time"});
  return run_story(story, interrupted, [&](double seconds) { progress.at(seconds); });
}

int tell_story(const StoryOptions& options, const MakeVideo& make_video) {
  const std::string script = options.script.empty() ? default_story().string() : options.script;
  keep_apart("--record", options.record, std::span(&script, 1));
  keep_apart("--video", options.video.out, std::span(&script, 1));
  keep_outputs_apart("--record", options.record, "--video", options.video.out);
  if (!options.video.out.empty()) return make_video(script, options.video, 0);
  const Story story = read_story(script);
  if (options.check) {
    print_steps(story);
    return 0;
  }
  if (!options.record.empty()) {
    check_ending(options.record, kSessionEnding);
    check_place(options.record, options.video.force);
  }
  const StoryRun run = tell_with_progress(story);
  print_numbers(story, run.session);
  if (!options.record.empty()) {
    try {
      write_session(run.session, {story.title, story.steps}, options.record, options.video.force);
    } catch (const FileError& e) {  // of the results, not of the input
      throw std::runtime_error(e.what());
    }
    fmt::print("recorded {} ticks of {} runs in {}\n", run.session.size(), run.session.lanes(),
               options.record);
  }
  for (const std::string& warning : warnings_of(run.session, script)) {
    fmt::print(stderr, "limpid: warning: {}\n", warning);
  }
  if (run.end.diverged) return 1;
  if (run.end.stopped) {
    fmt::print(stderr, "limpid: stopped at {:.1f} of {:.1f} s\n",
               static_cast<double>(run.session.size()) * run.session.info.tick, story.seconds());
  }
  return run.end.stopped ? 1 : 0;
}

}  // namespace

Command declare_story(CLI::App& app, MakeVideo make_video) {
  auto* command = app.add_subcommand(
      "story",
      "runs a script (a story): prints what happens in each step, writes a session or a video");
  auto options = std::make_shared<StoryOptions>();
  command
      ->add_option("FILE.toml", options->script,
                   "the script; default: first.toml, which is installed with Limpid")
      ->transform(or_shipped({"stories"}), "", "")
      ->type_name("");
  auto* record =
      command->add_option("--record", options->record, "write all runs to this session file")
          ->type_name("OUT.h5");
  auto* check = command->add_flag("--check", options->check,
                                  "read the script and list the steps, without running them");
  options->video.add(*command);
  CLI::Option* video = command->get_option("--video");
  command->get_option("--force")->remove_needs(video);  // also for a session
  video->excludes(record)->excludes(check);
  record->excludes(check);
  command->footer("How to write a story: the chapter *Stories* of `limpid manual`.");
  return [options, make_video = std::move(make_video)] { return tell_story(*options, make_video); };
}

}  // namespace limpid
