#include "app/experiments/experiment.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <vector>

#include "app/base/interrupt.h"
#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/cli/out_folder.h"
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
  prepare_out(options.out);
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
