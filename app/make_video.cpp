#include "app/make_video.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>

#include "app/base/interrupt.h"
#include "app/cli/options.h"
#include "app/cli/progress.h"
#include "app/film/session_film.h"
#include "app/run/run_watch.h"
#include "app/story/run_story.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// Reads the size, "1280x720", and the other options of the picture.
FilmLook look(const VideoOptions& options, double text_scale) {
  FilmLook look{.plots = options.plots,
                .overlaid = options.overlaid,
                .lens = options.lens,
                .text_scale = text_scale};
  if (options.size.empty()) return look;
  int width = 0, height = 0, read = 0;
  if (std::sscanf(options.size.c_str(), "%5dx%5d%n", &width, &height, &read) != 2 ||
      static_cast<std::size_t>(read) != options.size.size()) {
    throw UsageError(
        fmt::format("--size: \"{}\" is not allowed; allowed: WIDTHxHEIGHT, such as "
                    "1280x720",
                    options.size));
  }
  look.width = width;
  look.height = height;
  return look;
}

// Size of a file, or of all files in a folder [MB].
double megabytes(const fs::path& out) {
  std::error_code none;
  if (!fs::is_directory(out, none)) return static_cast<double>(fs::file_size(out, none)) / 1e6;
  double sum = 0;
  for (const auto& entry : fs::directory_iterator(out, none)) {
    sum += static_cast<double>(entry.file_size(none)) / 1e6;
  }
  return sum;
}

FilmOrder order_of(const VideoOptions& options, double text_scale) {
  return {.out = options.out,
          .force = options.force,
          .look = look(options, text_scale),
          .fps = options.fps,
          .from = options.from,
          .to = options.to,
          .speed = options.speed,
          .rerun = options.rerun};
}

// Says which options of the picture have no effect on a recording of so many runs.
void say_without_effect(const VideoOptions& options, std::size_t runs) {
  const auto say = [](const std::string& what) { fmt::print(stderr, "limpid: {}\n", what); };
  if (!options.rerun.empty() && runs > 1) {
    say(fmt::format("--rerun: shows only the first run and its re-run; {} not shown",
                    runs == 2 ? "the second run is" : "further runs are"));
    return;
  }
  if (options.lens && runs > 1 && !options.overlaid) {
    say("--lens: has no effect on runs side by side; --overlaid draws them in one picture");
  }
  if (options.overlaid && runs == 1 && options.rerun.empty()) {
    say("--overlaid: has no effect on a recording of one run");
  }
}

int stopped(double at, double whole, const std::string& out) {
  fmt::print(stderr, "limpid: stopped at {:.1f} of {:.1f} s; {} was not written\n", at, whole, out);
  return 1;
}

int make(const FilmOrder& order, const Session& session, const std::string& where,
         bool print_progress) {
  const FilmCut plan = cut(order, session, where);
  const auto began = std::chrono::steady_clock::now();
  FilmEnd end;
  {
    Progress progress(
        {.title = "video", .whole = plan.duration(), .unit = "s", .rate = "times real time"});
    end = film(session, where, order, interrupted, [&](double part) {
      progress.at(part * plan.duration());
      if (print_progress) {
        fmt::print("{:.3f}\n", part);
        std::fflush(stdout);
      }
    });
  }
  const std::string out = order.out.string();
  if (end.stopped) return stopped(end.seconds, plan.duration(), out);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  fmt::print("{}: {} pictures, {:.2f} s, {} x {}, {:.2f} MB, made in {:.1f} s\n", out,
             plan.pictures(), plan.duration(), order.look.width, order.look.height, megabytes(out),
             took.count());
  return 0;
}

}  // namespace

int make_video(const std::string& file, const VideoOptions& options, double text_scale,
               char** /*words*/) {
  FilmOrder order = order_of(options, text_scale);
  order.title = fs::path(file).stem().string();
  const Session session = read_session(file);
  ToldSteps told = told_in(session, file);
  order.steps = std::move(told.steps);
  if (!told.title.empty()) order.title = told.title;
  cut(order, session, file);
  say_without_effect(options, session.lanes());
  catch_interrupts();
  return make(order, session, file, options.print_progress);
}

int make_story_video(const std::string& script, const VideoOptions& options, char** /*words*/) {
  const Story story = read_story(script);
  FilmOrder order = order_of(options, 0);
  order.title = story.title;
  order.steps = story.steps;
  say_without_effect(options, story.plan.lanes());
  catch_interrupts();
  StoryRun run;
  {
    Progress progress({.title = "story", .whole = story.seconds(), .unit = "s", .rate = ""});
    run = run_story(story, interrupted, [&](double seconds) { progress.at(seconds); });
  }
  if (run.end.stopped) return stopped(0, story.seconds(), options.out);
  const int status = make(order, run.session, script, options.print_progress);
  for (const std::string& warning : warnings_of(run.session, script)) {
    fmt::print(stderr, "limpid: warning: {}\n", warning);
  }
  return run.end.diverged ? 1 : status;
}

}  // namespace limpid
