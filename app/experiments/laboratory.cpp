#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "app/experiments/experiment.h"
#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "devices/files/config_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// The recorded hand went where the plan's hand goes.
bool same_hand(const Session& session, const RunPlan& plan) {
  for (std::size_t k = 0; k < session.size(); ++k) {
    const Vec3 target = plan.hand.sample(k, plan.parameters.tick);
    if (!std::ranges::equal(session.at(k, Column::hand_target), target)) return false;
  }
  return true;
}

// A session file stands for a trial if it says the same of itself and its hand, and was run to the
// end of the plan or of the loop's stability.
bool stands_for(const Session& session, const SessionInfo& info, const RunPlan& plan) {
  const SessionInfo& s = session.info;
  return s.config == info.config && s.device_urdf == info.device_urdf && s.scene == info.scene &&
         s.source == info.source && s.seed == info.seed && s.app_version == info.app_version &&
         s.tick == info.tick && session.size() > 0 && session.size() <= plan.rows &&
         same_hand(session, plan);
}

// A file that cannot be read stands for nothing and will be replaced.
std::optional<Session> read_if_session(const fs::path& file) {
  std::error_code none;
  if (!fs::exists(file, none)) return std::nullopt;
  try {
    return read_session(file);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

}  // namespace

Laboratory::Laboratory(std::string experiment, Options options)
    : experiment_(std::move(experiment)), options_(std::move(options)) {
  if (options_.threads == 0) options_.threads = std::max(1u, std::thread::hardware_concurrency());
}

TrialResult Laboratory::run_one(const Trial& trial) const {
  TrialResult result;
  result.session.info = session_info(trial.plan);
  result.session.layout = RowLayout(trial.plan.arm.dof());
  const std::string& folder = trial.folder.empty() ? experiment_ : trial.folder;
  const fs::path file = options_.dir / folder / (trial.name + ".h5");
  if (trial.keep) {
    std::optional<Session> found = read_if_session(file);
    if (found && stands_for(*found, result.session.info, trial.plan)) {
      // A closed file that ends early is of a loop that became unstable there.
      const std::uint64_t rows = found->size();
      return {std::move(*found), {.rows = rows, .diverged = rows < trial.plan.rows}};
    }
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
                        [&](std::span<const double> row, const Parameters*) {
                          rows.insert(rows.end(), row.begin(), row.end());
                          return !recorder || recorder->push_waiting(row);
                        });
  // What was cut short stays a .part and is run again another time.
  if (stopped()) throw Cancelled();
  if (recorder) recorder->finish();
  return result;
}

void Laboratory::run(const std::vector<Trial>& trials,
                     const std::function<void(std::size_t, const TrialResult&)>& take) {
  std::atomic<std::size_t> next{0};
  std::size_t done = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < trials.size(); i = next++) {
      try {
        const TrialResult result = run_one(trials[i]);
        take(i, result);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = trials.size();
        return;
      }
      const std::lock_guard lock(mutex);
      ++done;
      if (options_.progress) {
        options_.progress(static_cast<double>(done) / static_cast<double>(trials.size()));
      }
    }
  };
  {
    std::vector<std::jthread> threads;
    const auto count = std::min<std::size_t>(options_.threads, trials.size());
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back(work);
  }
  if (failure) std::rethrow_exception(failure);
}

std::vector<TrialResult> Laboratory::run(const std::vector<Trial>& trials) {
  std::vector<TrialResult> results(trials.size());
  run(trials, [&](std::size_t i, const TrialResult& result) { results[i] = result; });
  return results;
}

}  // namespace limpid
