#include "app/experiments/experiment.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <filesystem>

#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/interrupt.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kMostThreads = 256;

struct ExperimentOptions {
  std::string name;
  std::string out;
  std::uint64_t seed = 0;
  unsigned threads = 0;
};

std::vector<const Experiment*> chosen(const std::string& name) {
  std::vector<const Experiment*> all;
  std::string names = "all";
  for (const Experiment& e : experiments()) {
    all.push_back(&e);
    names += fmt::format(", {}", e.name);
  }
  if (name == "all") return all;
  if (const Experiment* one = find_experiment(name)) return {one};
  throw UsageError(fmt::format("\"{}\" is not an experiment; allowed: {}", name, names));
}

// Before the first trial, so that no work is lost on a place that cannot be written.
void prepare(const fs::path& dir) {
  std::error_code error;
  fs::create_directories(dir, error);
  if (!error && !fs::is_directory(dir)) error = std::make_error_code(std::errc::not_a_directory);
  if (!error && access(dir.c_str(), W_OK | X_OK) != 0) error = {errno, std::generic_category()};
  if (error) throw UsageError(fmt::format("--out {}: {}", dir.string(), error.message()));
}

// "passivity (3 of 8): 45 %, 12 s left" on a terminal.
class Progress {
 public:
  Progress(const char* name, std::size_t index, std::size_t count)
      : title_(fmt::format("{} ({} of {})", name, index + 1, count)) {}
  ~Progress() {
    if (shown_) fmt::print(stderr, "\r\x1b[K");
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void at(double part) {
    if (isatty(STDERR_FILENO) == 0) return;
    if (part < part_) began_ = std::chrono::steady_clock::now();  // its next series of trials
    part_ = part;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - began_;
    const double left = part > 0 ? elapsed.count() * (1 - part) / part : 0;
    fmt::print(stderr, "\r\x1b[K{}: {:.0f} %, {:.0f} s left ", title_, 100 * part, left);
    std::fflush(stderr);
    shown_ = true;
  }

 private:
  std::string title_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  double part_ = 0;
  bool shown_ = false;
};

void print(const Experiment& experiment, const Outcome& outcome) {
  fmt::print("{}: {}\n", experiment.name, outcome.passed() ? "passed" : "FAILED");
  for (const Check& c : outcome.checks) {
    fmt::print("  {}  {}: {:.4g}, bound {:.4g}\n", c.passed ? "ok  " : "FAIL", c.what, c.value,
               c.bound);
  }
  std::fflush(stdout);
}

Outcome carry_out_with_progress(const Experiment& experiment, const ExperimentOptions& options,
                                std::size_t index, std::size_t count) {
  Progress progress(experiment.name, index, count);
  return carry_out(experiment, {.dir = options.out,
                                .seed = options.seed,
                                .threads = options.threads,
                                .stop = &interrupted,
                                .progress = [&](double part) { progress.at(part); }});
}

int run(const ExperimentOptions& options) {
  const std::vector<const Experiment*> wanted = chosen(options.name);
  prepare(options.out);
  catch_interrupts();
  bool passed = true;
  try {
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const Outcome outcome = carry_out_with_progress(*wanted[i], options, i, wanted.size());
      print(*wanted[i], outcome);
      passed = passed && outcome.passed();
      write_report(options.out);
    }
  } catch (const Cancelled&) {
    fmt::print(stderr, "limpid: stopped; the same command goes on from here\n");
    return 1;
  } catch (const FileError& e) {  // of this run's own making, no bad input
    throw std::runtime_error(e.what());
  }
  fmt::print("report: {}\n", (fs::path(options.out) / "report.html").string());
  if (!passed) fmt::print(stderr, "limpid: checks failed\n");
  return passed ? 0 : 1;
}

std::string experiment_help() {
  std::string text = "Experiments:\n";
  for (const Experiment& e : experiments()) text += fmt::format("  {:<14} {}\n", e.name, e.about);
  return text +
         "  all            one after the other\n\n"
         "Writes DIR/NAME.csv, .png, .svg and .json, DIR/report.html and the sessions of\n"
         "the trials. Called again with the same DIR it goes on where it was stopped.\n"
         "Exit status 1: a check failed, or it was stopped.";
}

}  // namespace

Command declare_experiment(CLI::App& app) {
  auto* command =
      app.add_subcommand("experiment", "one of the paper's experiments: data, figure, verdict");
  auto options = std::make_shared<ExperimentOptions>();
  command->add_option("NAME", options->name, "an experiment, or all")->required();
  command->add_option("--out", options->out, "the folder for what it finds")
      ->required()
      ->type_name("DIR");
  require_whole_number(
      command->add_option("--seed", options->seed, "for whatever is random")->type_name("N"));
  command->add_option("--threads", options->threads, "default: one a core")
      ->type_name("N")
      ->check(CLI::Range(1u, kMostThreads));
  command->footer(experiment_help());
  return [options] { return run(*options); };
}

}  // namespace limpid
