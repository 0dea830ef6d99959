// Experiments: the runs that they make, their checks, and what comes of them.
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
#include <string>
#include <vector>

#include "app/run/simulate.h"
#include "app/study/figure.h"
#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"

namespace limpid {

// Under which conditions an experiment's runs were made, for its caption.

// Gathers them from the runs themselves, so that none goes unsaid: arm, limit of the motors, grip,
// mass of the hand, encoders, delay and tick.
class Conditions {
 public:
  void add(const ArmDescription& arm, const Parameters& p);

  // "Conditions: ...", a sentence; empty without any run.
  std::string text() const;
  // The same without the hand, which is a person's, and what belongs to a simulated device.
  std::string of_the_device() const;
  // Digest of all runs' settings, as settings_digest() has it; empty without any run.
  std::string settings() const;

 private:
  std::string arms() const;
  std::string motors() const;

  std::set<std::string> configs_;
  std::set<std::string> arms_;
  std::set<int> joints_;
  std::set<double> own_limits_;  // of the arms whose motors are not limited otherwise [N m]
  std::set<double> limits_;      // of every motor [N m]
  std::set<double> grips_;       // [N/m]
  std::set<double> dampers_;     // of grips [N s/m]
  std::set<double> masses_;      // [kg]
  std::set<double> encoders_;    // [rad]
  std::set<double> delays_;      // [ms]
  std::set<double> ticks_;       // [ms]
};

// The experiments: what each needs, finds and promises.
struct SweepPlan;
struct SweepTable;

// One promise: `value` stands in a relation to `bound` that `what` says in words.
struct Check {
  std::string what;
  double value = 0;
  double bound = 0;
  bool passed = false;
};

inline Check at_most(std::string what, double value, double bound) {
  return {std::move(what), value, bound, value <= bound};
}
inline Check at_least(std::string what, double value, double bound) {
  return {std::move(what), value, bound, value >= bound};
}

// The larger of two, for the worst of many; not a number if one of them is none: what could not be
// measured fails its check, where std::max would leave it out.
inline double worse(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? std::nan("") : std::max(a, b);
}

// The same of what should be large.
inline double worse_low(double a, double b) { return -worse(-a, -b); }

struct Outcome {
  Figure figure;
  std::vector<Check> checks;
  bool passed() const {
    for (const Check& c : checks) {
      if (!c.passed) return false;
    }
    return !checks.empty();
  }
};

// One run of the ordinary loop within an experiment.
struct Trial {
  std::string name;  // of its session file: DIR/NAME/name.h5
  RunPlan plan;
  bool keep = true;          // record it; maps of hundreds of short runs need not
  std::string folder = {};   // in place of NAME, for trials that experiments share
  bool may_diverge = false;  // whether it does is what is asked; any other that does is a failure
};

struct TrialResult {
  Session session;  // its rows, also those of trials that were not kept
  RunEnd end;
};

// Thrown where the user ended the work; what was finished stays.
struct Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("stopped") {}
};

// What an experiment runs in. Results do not depend on the number of threads.
class TrialRunner {
 public:
  struct Options {
    std::filesystem::path dir;
    std::uint64_t seed = 0;
    unsigned threads = 0;       // 0: one a core
    std::uint64_t program = 0;  // trials of another one are run again; 0: this program's
    const std::atomic<bool>* stop = nullptr;
    // Part done of the experiment, 0 to 1; called from any thread, one at a time.
    std::function<void(double part)> progress;
  };
  TrialRunner(std::string experiment, Options options);

  std::uint64_t seed() const { return options_.seed; }

  // Runs all trials on all cores, in any order; results in the order given. A kept trial whose
  // session file is there already, whole, from the same program and plan, is read instead of run.
  // Throws Cancelled; FileError.
  std::vector<TrialResult> run(const std::vector<Trial>& trials);
  // Runs trials too many to hold: `take` gets each result, from any thread, with its index.
  void run(const std::vector<Trial>& trials,
           const std::function<void(std::size_t, const TrialResult&)>& take);
  // How many diverged of those that may not.
  std::size_t diverged() const { return diverged_; }
  const Conditions& conditions() const { return conditions_; }  // of all that was run

  // All points of a plan. Throws Cancelled; std::runtime_error.
  SweepTable sweep(const SweepPlan& plan);

 private:
  // Does every one of them, on all cores.
  void each(std::size_t count, const std::function<void(std::size_t)>& work);
  TrialResult run_one(const Trial& trial) const;
  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  std::string experiment_;
  Options options_;
  Conditions conditions_;
  std::atomic<std::size_t> diverged_{0};
};

struct Experiment {
  const char* name;
  const char* about;  // one line
  Outcome (*run)(TrialRunner&);
};

// The paper's in its order, then those of the predictive coupling and of bodies that move.
std::span<const Experiment> experiments();

// Writes DIR/NAME.csv, .png, .svg and .json. Errors: FileError.
void write_outcome(const std::string& name, const Outcome& outcome,
                   const std::filesystem::path& dir);

// Runs one and writes DIR/NAME.csv, .png, .svg and .json; its caption says under which conditions
// it was run, and a check of its own that no trial diverged that may not. Errors: FileError,
// Cancelled, std::runtime_error.
Outcome carry_out(const Experiment& experiment, const TrialRunner::Options& options);

// Writes DIR/report.html over every verdict found in DIR.
void write_report(const std::filesystem::path& dir);

// Trials that were run before: taken again only from the very same program and plan.

// Beside NAME.h5 lies NAME.key: the trial's key and what the session file's bytes add up to.
// Written once the recording is closed. Errors: FileError.
void stamp(const std::filesystem::path& session, std::uint64_t key);
// The recording, if its stamp is there, says the same key, and not a byte has changed since.
std::optional<Session> stamped_session(const std::filesystem::path& file, std::uint64_t key);

}  // namespace limpid
