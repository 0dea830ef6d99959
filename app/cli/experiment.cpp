#include "app/experiments/experiment.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <filesystem>
#include <vector>

#include "app/base/interrupt.h"
#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/cli/progress.h"

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

// Tries a file there, so that what forbids it is known. 0, or errno.
int try_to_write(const fs::path& dir) {
  const std::string probe = (dir / fmt::format(".{}.probe", getpid())).string();
  const int descriptor = open(probe.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (descriptor < 0) return errno;
  const std::vector<char> some(1 << 16);
  errno = ENOSPC;  // what a short write means
  const bool written =
      write(descriptor, some.data(), some.size()) == std::ssize(some) && fsync(descriptor) == 0;
  const int code = written ? 0 : errno;
  close(descriptor);
  unlink(probe.c_str());
  return code;
}

// Before the first trial, so that no work is lost on a place that cannot be written or is full.
void prepare(const fs::path& dir) {
  std::error_code error;
  const bool created = fs::create_directories(dir, error);
  if (!error && !fs::is_directory(dir)) error = std::make_error_code(std::errc::not_a_directory);
  if (!error) error = {try_to_write(dir), std::generic_category()};
  if (!error) return;
  std::error_code none;
  if (created) fs::remove(dir, none);
  throw UsageError(fmt::format("--out {}: {}", dir.string(), error.message()));
}

void print(const Experiment& experiment, const Outcome& outcome) {
  fmt::print("{}: {}\n", experiment.name, outcome.passed() ? "passed" : "FAILED");
  for (const Check& c : outcome.checks) {
    fmt::print("  {}  {}: {:.4g}, bound {:.4g}\n", c.passed ? "ok  " : "FAIL", c.what, c.value,
               c.bound);
  }
  std::fflush(stdout);
}

// In words, with the experiment they are of. One without checks promises nothing.
void note_failures(const Experiment& experiment, const Outcome& outcome,
                   std::vector<std::string>& failed) {
  for (const Check& c : outcome.checks) {
    if (!c.passed) failed.push_back(fmt::format("{}: {}", experiment.name, c.what));
  }
  if (outcome.checks.empty()) failed.push_back(fmt::format("{}: no checks", experiment.name));
}

Outcome carry_out_with_progress(const Experiment& experiment, const ExperimentOptions& options,
                                std::size_t index, std::size_t count) {
  Progress progress({.title = fmt::format("{} ({} of {})", experiment.name, index + 1, count),
                     .whole = 100,
                     .unit = "",
                     .rate = "% a second"});
  return carry_out(experiment, {.dir = options.out,
                                .seed = options.seed,
                                .threads = options.threads,
                                .stop = &interrupted,
                                .progress = [&](double part) { progress.at(100 * part); }});
}

int run(const ExperimentOptions& options) {
  const std::vector<const Experiment*> wanted = chosen(options.name);
  prepare(options.out);
  catch_interrupts();
  std::vector<std::string> failed;  // checks
  try {
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const Outcome outcome = carry_out_with_progress(*wanted[i], options, i, wanted.size());
      print(*wanted[i], outcome);
      note_failures(*wanted[i], outcome, failed);
      write_report(options.out);
    }
  } catch (const Cancelled&) {
    fmt::print(stderr, "limpid: stopped; the same command goes on from here\n");
    return 1;
  } catch (const FileError& e) {  // of this run's own making, no bad input
    throw std::runtime_error(e.what());
  }
  fmt::print("report: {}\n", (fs::path(options.out) / "report.html").string());
  if (!failed.empty()) {
    fmt::print(stderr, "limpid: {} failed: {}\n", failed.size() == 1 ? "a check" : "checks",
               fmt::join(failed, "; "));
  }
  return failed.empty() ? 0 : 1;
}

std::string experiment_help() {
  std::string text = "Experiments:\n";
  for (const Experiment& e : experiments()) text += fmt::format("  {:<14} {}\n", e.name, e.about);
  return text +
         "  all            one after the other\n\n"
         "Writes DIR/NAME.csv, .png, .svg and .json, DIR/report.html and the sessions of\n"
         "the trials. Called again with the same DIR it goes on where it was stopped; trials of\n"
         "another version of the program, or of other inputs, are run again.\n"
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
