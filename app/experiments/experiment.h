// Experiments: their runs, checks and results.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/experiments/experiment_arm.h"
#include "app/plot/figure.h"
#include "app/run/simulate.h"
#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"

namespace limpid {

// Conditions under which an experiment's runs were made, for its caption: arm, limit of the motors,
// grip, mass of the hand, encoders, delay and tick. They come from the runs, so that none is left
// out.
class Conditions {
 public:
  void add(const ArmDescription& arm, const Parameters& p);

  // "Conditions: ...", a sentence; empty without any run.
  std::string text() const;
  // The same sentence without the hand and what only simulated devices have.
  std::string of_the_device() const;
  // Digest of all runs' settings, by settings_digest(); empty without any run.
  std::string settings() const;

 private:
  std::string arms() const;
  std::string motors() const;

  std::set<std::string> configs_;
  std::set<std::string> arms_;
  std::set<int> joints_;
  std::set<double> own_limits_;  // limits of arms whose motors have no other [N m]
  std::set<double> limits_;      // of every motor [N m]
  std::set<double> grips_;       // [N/m]
  std::set<double> dampers_;     // of grips [N s/m]
  std::set<double> masses_;      // [kg]
  std::set<double> encoders_;    // [rad]
  std::set<double> delays_;      // [ms]
  std::set<double> ticks_;       // [ms]
};

struct SweepPlan;
struct SweepTable;

// A measured value beside the one that theory expects; a check's value is then the error.
struct Comparison {
  std::optional<double> expected;  // none: no theory says it, and the check's value is measured
  double measured = 0;
  std::string unit;
  std::string conditions;  // a sentence
};

// A promise: `value` is at most `bound`, or at least.
struct Check {
  std::string what;
  double value = 0;
  double bound = 0;
  bool passed = false;
  std::optional<Comparison> against = {};
  std::string unjudged = {};  // sentence on why the value is only measured; empty: it is judged
  bool least = false;         // the value is to be at least the bound, else at most

  bool failed() const { return !passed && unjudged.empty(); }
};

// Returns how a check's value is judged by its bound, in words.
inline const char* relation(const Check& c) {
  return !c.unjudged.empty() ? "measured" : c.least ? "at least" : "at most";
}

inline Check at_most(std::string what, double value, double bound) {
  return {std::move(what), value, bound, value <= bound};
}
inline Check at_least(std::string what, double value, double bound) {
  return {.what = std::move(what),
          .value = value,
          .bound = bound,
          .passed = value >= bound,
          .least = true};
}

// The larger of two, for the worst of many. NaN if either is NaN, so that what could not be
// measured fails its check; std::max would drop it.
inline double worse(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? std::nan("") : std::max(a, b);
}

// The smaller of two, for the worst of many values that should be large; NaN as in worse().
inline double worse_low(double a, double b) { return -worse(-a, -b); }

struct Outcome {
  Figure figure;
  std::vector<Check> checks;
  std::string arm = {};  // that is not the one whose bounds are promised; empty: it is
  bool passed() const {
    for (const Check& c : checks) {
      if (c.failed()) return false;
    }
    return !checks.empty();
  }
};

// A run of the ordinary loop within an experiment.
struct Trial {
  std::string name;  // of its session file: DIR/NAME/name.h5
  RunPlan plan;
  bool keep = true;          // recorded; maps of hundreds of short runs need no recordings
  std::string folder = {};   // in place of NAME, for trials that experiments share
  bool may_diverge = false;  // diverging is what is tested; else it is a failure
};

struct TrialResult {
  Session session;  // rows too, even if the trial was not kept
  RunEnd end;
};

// Thrown where the user ended the work; what was finished stays.
struct Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("stopped") {}
};

// Runs the trials of an experiment. Results do not depend on the number of threads.
class TrialRunner {
 public:
  struct Options {
    std::filesystem::path dir;
    std::uint64_t seed = 0;
    unsigned threads = 0;       // 0: one a core
    std::uint64_t program = 0;  // trials recorded by another program are run again; 0: this program
    std::optional<ExperimentArm> arm = {};  // none: the built-in arm
    const std::atomic<bool>* stop = nullptr;
    // Receives the share of the experiment that is done, 0 to 1; called from any thread, one call
    // at a time.
    std::function<void(double part)> progress;
  };
  TrialRunner(std::string experiment, Options options);

  std::uint64_t seed() const { return options_.seed; }
  const ExperimentArm& arm() const { return *options_.arm; }

  // Runs all trials on all cores, in any order; results in the order given. A kept trial with a
  // complete recording from the same program and plan is read instead. Errors: Cancelled,
  // FileError; std::runtime_error for a hand that the arm cannot follow.
  std::vector<TrialResult> run(const std::vector<Trial>& trials);
  // Runs trials too many to hold: `take` gets each result, from any thread, with its index.
  void run(const std::vector<Trial>& trials,
           const std::function<void(std::size_t, const TrialResult&)>& take);
  // Number of trials that diverged without may_diverge.
  std::size_t diverged() const { return diverged_; }
  const Conditions& conditions() const { return conditions_; }  // of all trials run

  // Runs all points of a plan. Errors: Cancelled, std::runtime_error.
  SweepTable sweep(const SweepPlan& plan);

  // Calls `work` for each index below `count`, on all cores.
  void each(std::size_t count, const std::function<void(std::size_t)>& work);
  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

 private:
  TrialResult run_one(const Trial& trial) const;

  std::string experiment_;
  Options options_;
  Conditions conditions_;
  std::atomic<std::size_t> diverged_{0};
};

struct Experiment {
  const char* name;
  const char* about;  // one line
  Outcome (*run)(TrialRunner&);
  enum class Takes : std::uint8_t { any, moving_as_built_in, none };
  Takes takes = Takes::any;       // arms, of three joints
  const char* own_arms = "";      // what it has instead, if it takes none
  const char* own_readings = "";  // why the readings of an arm's file have no place; empty: they do
};

// An experiment whose hand's path the arm does not reach.
struct OutOfReach : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Says why an experiment does not run on an arm; empty if it does.
std::string why_not(const Experiment& experiment, const ExperimentArm& on);

// The paper's experiments in its order, then those of the predictive coupling and of bodies that
// move.
std::span<const Experiment> experiments();

// Writes DIR/NAME.csv, .png, .svg and .json. `more`: a JSON object whose members the file has
// besides; empty: none. Errors: FileError.
void write_outcome(const std::string& name, const Outcome& outcome,
                   const std::filesystem::path& dir, const std::string& more = {});

// Runs `experiment`, then write_outcome(). Adds the conditions to the caption, and a check that no
// trial diverged against expectation. On an arm for which no bounds are promised all other checks
// are measured and not judged. Errors: FileError, Cancelled, std::runtime_error.
Outcome carry_out(const Experiment& experiment, const TrialRunner::Options& options);

// Writes DIR/report.html with every verdict found in DIR.
void write_report(const std::filesystem::path& dir);
// Returns the part of a report about DIR/NAME.json: figure, caption and checks; empty if it is not
// there.
std::string report_section(const std::string& name, const std::string& about,
                           const std::filesystem::path& dir);

// Writes NAME.key beside NAME.h5: the trial's key and a digest of the recording. Call it once the
// recording is closed. Errors: FileError.
void stamp(const std::filesystem::path& session, std::uint64_t key);
// Reads a recording if its stamp has the same key and its bytes have not changed since.
std::optional<Session> stamped_session(const std::filesystem::path& file, std::uint64_t key);

}  // namespace limpid
