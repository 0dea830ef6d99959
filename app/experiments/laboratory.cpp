#include <algorithm>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "app/experiments/experiment.h"
#include "app/experiments/trial_store.h"
#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "app/run/run_key.h"
#include "app/sweep/sweep_table.h"

namespace limpid {

namespace fs = std::filesystem;

Laboratory::Laboratory(std::string experiment, Options options)
    : experiment_(std::move(experiment)), options_(std::move(options)) {
  if (options_.threads == 0) options_.threads = std::max(1u, std::thread::hardware_concurrency());
  if (options_.program == 0) options_.program = program_digest();
}

TrialResult Laboratory::run_one(const Trial& trial) const {
  TrialResult result;
  result.session.info = session_info(trial.plan);
  result.session.layout = RowLayout(trial.plan.arm.dof());
  const std::string& folder = trial.folder.empty() ? experiment_ : trial.folder;
  const fs::path file = options_.dir / folder / (trial.name + ".h5");
  const std::uint64_t key = trial.keep ? trial_key(trial.plan, options_.program) : 0;
  if (auto found = trial.keep ? stamped_session(file, key) : std::nullopt) {
    const RunEnd end = end_of(*found);
    return {std::move(*found), end};
  }
  if (stopped()) throw Cancelled();
  std::optional<Recorder> recorder;
  if (trial.keep) {
    fs::create_directories(file.parent_path());
    recorder.emplace(file, result.session.info, trial.plan.parameters, true,
                     Recorder::kWaitingRoom);
  }
  std::vector<double>& rows = result.session.rows;
  rows.reserve(trial.plan.rows * static_cast<std::size_t>(result.session.layout.stride()));
  result.end = simulate(trial.plan, {.realtime = false, .stop = options_.stop},
                        [&](std::span<const double> row, const Parameters* changed) {
                          rows.insert(rows.end(), row.begin(), row.end());
                          if (recorder && changed != nullptr) recorder->changed(*changed);
                          return !recorder || recorder->push_waiting(row);
                        });
  // What was cut short stays a .part and is run again another time.
  if (stopped()) throw Cancelled();
  if (recorder) {
    recorder->finish();
    stamp(file, key);
  }
  return result;
}

void Laboratory::each(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::size_t done = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work_on = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = count;
        return;
      }
      const std::lock_guard lock(mutex);
      ++done;
      if (options_.progress) {
        options_.progress(static_cast<double>(done) / static_cast<double>(count));
      }
    }
  };
  {
    std::vector<std::jthread> threads;
    const auto most = std::min<std::size_t>(options_.threads, count);
    for (std::size_t i = 0; i < most; ++i) threads.emplace_back(work_on);
  }
  if (failure) std::rethrow_exception(failure);
}

void Laboratory::run(const std::vector<Trial>& trials,
                     const std::function<void(std::size_t, const TrialResult&)>& take) {
  for (const Trial& trial : trials) conditions_.add(trial.plan.arm, trial.plan.parameters);
  each(trials.size(), [&](std::size_t i) {
    const TrialResult result = run_one(trials[i]);
    if (result.end.diverged && !trials[i].may_diverge) ++diverged_;
    take(i, result);
  });
}

SweepTable Laboratory::sweep(const SweepPlan& plan) {
  SweepTable table(plan);
  for (std::uint64_t i = 0; i < table.points(); ++i) {
    const RunPlan run = run_of(plan, table.rows.point(i));
    conditions_.add(run.arm, run.parameters);
  }
  static const std::atomic<bool> kNever{false};
  const std::atomic<bool>& stop = options_.stop != nullptr ? *options_.stop : kNever;
  each(table.points(), [&](std::size_t i) {
    const auto values = measure_point(plan, table.rows.point(i), stop);
    if (!values) throw Cancelled();
    table.take(i, *values);
  });
  return table;
}

std::vector<TrialResult> Laboratory::run(const std::vector<Trial>& trials) {
  std::vector<TrialResult> results(trials.size());
  run(trials, [&](std::size_t i, const TrialResult& result) { results[i] = result; });
  return results;
}

}  // namespace limpid
