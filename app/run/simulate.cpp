#include "app/run/simulate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <stdexcept>

#include "app/run/summary.h"
#include "core/realtime/haptic_thread.h"
#include "devices/files/config_file.h"

namespace limpid {

std::uint64_t ticks_in(double duration, double T) {
  return static_cast<std::uint64_t>(std::max(1LL, std::llround(duration / T)));
}

HandInput input_at(const HandPath& path, std::size_t k, double T) {
  return {path.sample(k, T),
          path.grip_sample(k, T),
          {},
          path.magnet_sample(k, T),
          path.pull_sample(k, T)};
}

namespace {

void note(RunEnd& end, const DivergenceWatch& watch) {
  if (!watch.lost()) return;
  end.diverged = true;
  end.diverged_at = watch.since();
  end.why = watch.why();
}

// A lane under way: a rig and the changes of its settings.
class LaneRun {
 public:
  LaneRun(const RunPlan& plan, const Lane& lane)
      : rig(plan.arm, plan.document.scene),
        watch(rig.layout()),
        parameters(lane.parameters),
        changes_(lane.changes) {
    parameters.tick = plan.parameters.tick;
  }

  // Applies the changes up to row k; returns whether there was any.
  bool apply_changes(std::uint64_t k) {
    bool changed = false;
    for (; next_ < changes_.size() && changes_[next_].row <= k; ++next_) {
      apply_change(parameters, changes_[next_]);
      changed = true;
    }
    return changed;
  }
  void step(const RigInput& input, double wake_latency, std::span<double> row) {
    const auto began = std::chrono::steady_clock::now();
    rig.step(parameters, input, row);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    rig.layout().in(row, Column::wake_latency)[0] = wake_latency;
    rig.layout().in(row, Column::compute)[0] = took.count();
    watch.add(row);
  }

  Rig rig;
  DivergenceWatch watch;
  Parameters parameters;

 private:
  const std::vector<SettingChange>& changes_;
  std::size_t next_ = 0;
};

// A run as a sequence of ticks of all its lanes, whoever paces them.
class Run {
 public:
  Run(const RunPlan& plan, const RunPace& pace, const RowSink& sink)
      : plan_(plan), pace_(pace), sink_(sink) {
    for (std::size_t i = 0; i < plan.lanes(); ++i) lanes_.emplace_back(plan, plan.lane(i));
    rows_.resize(lanes_.size() * stride());
    changed_.resize(lanes_.size());
    const RigStart start = plan.start ? *plan.start : rest_at(plan.arm, plan.hand.sample(0, T()));
    for (std::size_t i = 0; i < plan.lanes(); ++i) {
      lanes_[i].rig.start(lanes_[i].parameters, plan.lane(i).start.value_or(start));
    }
    armed_ = start.armed;
  }

  // Runs one tick; false when the run is over.
  bool step(double wake_latency) {
    if (end_.rows >= plan_.rows) return false;
    if (pace_.stop != nullptr && pace_.stop->load(std::memory_order_relaxed)) {
      end_.stopped = true;
      return false;
    }
    const auto k = static_cast<std::size_t>(end_.rows);
    RigInput input{hand(k), wish(k)};
    if (k < plan_.excitation.size()) input.excitation = plan_.excitation[k];
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      changed_[i] = lanes_[i].apply_changes(end_.rows) ? &lanes_[i].parameters : nullptr;
      lanes_[i].step(input, wake_latency, std::span(rows_).subspan(i * stride(), stride()));
    }
    ++end_.rows;
    end_.stopped = !sink_(rows_, changed_);
    for (const LaneRun& lane : lanes_) {
      if (!end_.diverged) note(end_, lane.watch);
    }
    return !end_.stopped && !end_.diverged;
  }

  const RunEnd& end() const { return end_; }

 private:
  double T() const { return plan_.parameters.tick; }
  std::size_t stride() const { return static_cast<std::size_t>(lanes_[0].rig.layout().stride()); }

  HandInput hand(std::size_t k) const {
    HandInput input = input_at(plan_.hand, k, T());
    if (plan_.hand_torque.empty()) return input;
    const auto n = static_cast<std::size_t>(lanes_[0].rig.dof());
    const std::size_t last = plan_.hand_torque.size() / n - 1;
    const double recorded = static_cast<double>(k) * T() / plan_.hand.tick;
    const auto row = std::min(static_cast<std::size_t>(std::llround(recorded)), last);
    input.grip = 0;
    input.torque = std::span(plan_.hand_torque).subspan(n * row, n);
    return input;
  }

  ForceRequest wish(std::size_t k) {
    const bool armed = plan_.force.empty() || plan_.force[std::min(k, plan_.force.size() - 1)];
    if (armed == armed_) return ForceRequest::as_it_is;
    armed_ = armed;
    return armed ? ForceRequest::arm : ForceRequest::cut;
  }

  const RunPlan& plan_;
  const RunPace& pace_;
  const RowSink& sink_;
  std::deque<LaneRun> lanes_;
  std::vector<double> rows_;
  std::vector<const Parameters*> changed_;
  bool armed_ = true;
  RunEnd end_;
};

void run_paced(Run& run, double tick) {
  std::mutex mutex;
  std::condition_variable finished;
  bool over = false;
  HapticThread thread;
  thread.start(nanoseconds(std::llround(tick * 1e9)), [&](const TickTiming& timing) {
    if (over || run.step(timing.wake_latency)) return;
    const std::lock_guard lock(mutex);
    over = true;
    finished.notify_one();
  });
  std::unique_lock lock(mutex);
  while (!finished.wait_for(lock, std::chrono::milliseconds(100), [&] { return over; })) {
    if (!thread.status().running) break;
  }
  lock.unlock();
  thread.stop();
  if (const std::string failure = thread.status().failure; !failure.empty()) {
    throw std::runtime_error(failure);
  }
}

}  // namespace

// A setting without a value goes back to the arm's own.
void apply_change(Parameters& p, const SettingChange& change) {
  if (is_retired(change.key())) return;
  if (!change.setting.ends_with("= ")) return apply_setting(p, change.setting);
  const ParameterInfo* info = find_parameter(change.key());
  if (info == nullptr) throw ParameterError(std::string(change.key()) + ": no such key");
  if (info->kind == FieldInfo::Kind::number) set_parameter_number(p, *info, kFromArm);
}

RunEnd end_of(const Session& session) {
  DivergenceWatch watch(session.layout);
  for (std::size_t k = 0; k < session.size(); ++k) watch.add(session.row(k));
  RunEnd end;
  end.rows = session.size();
  note(end, watch);
  return end;
}

std::vector<Parameters> RunPlan::settings() const {
  std::vector<Parameters> all;
  for (std::size_t i = 0; i < lanes(); ++i) all.push_back(lane(i).parameters);
  return all;
}

RunEnd simulate(const RunPlan& plan, const RunPace& pace, const RowSink& sink) {
  Run run(plan, pace, sink);
  if (pace.realtime) {
    run_paced(run, plan.parameters.tick);
  } else {
    while (run.step(0)) {
    }
  }
  return run.end();
}

}  // namespace limpid
