#include "app/run/simulate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <stdexcept>

#include "app/run/divergence.h"
#include "core/realtime/haptic_thread.h"
#include "devices/files/config/config_file.h"

namespace limpid {
namespace {

void note(RunEnd& end, const DivergenceWatch& watch) {
  if (!watch.lost()) return;
  end.diverged = true;
  end.diverged_at = watch.since();
  end.why = watch.why();
}

// The run as a sequence of ticks, whoever paces them.
class Run {
 public:
  Run(const RunPlan& plan, const RunPace& pace, const RowSink& sink)
      : plan_(plan),
        pace_(pace),
        sink_(sink),
        rig_(plan.arm, plan.document.scene),
        watch_(rig_.layout()),
        parameters_(plan.parameters),
        row_(static_cast<std::size_t>(rig_.layout().stride())) {
    const RigStart start = plan.start ? *plan.start : rest_at(plan.arm, plan.hand.sample(0, T()));
    rig_.start(parameters_, start);
    armed_ = start.armed;
  }

  // One tick; false when the run is over.
  bool step(double wake_latency) {
    if (end_.rows >= plan_.rows) return false;
    if (pace_.stop != nullptr && pace_.stop->load(std::memory_order_relaxed)) {
      end_.stopped = true;
      return false;
    }
    const auto k = static_cast<std::size_t>(end_.rows);
    const bool changed = apply_changes();
    const auto began = std::chrono::steady_clock::now();
    rig_.step(parameters_, {hand(k), wish(k)}, row_);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    rig_.layout().in(std::span(row_), Column::wake_latency)[0] = wake_latency;
    rig_.layout().in(std::span(row_), Column::compute)[0] = took.count();
    ++end_.rows;
    end_.stopped = !sink_(row_, changed ? &parameters_ : nullptr);
    watch_.add(row_);
    note(end_, watch_);
    return !end_.stopped && !end_.diverged;
  }

  const RunEnd& end() const { return end_; }

 private:
  double T() const { return parameters_.tick; }

  HandInput hand(std::size_t k) const {
    const Vec3 target = plan_.hand.sample(k, T());
    if (plan_.hand_torque.empty()) return {target, plan_.hand.grip_sample(k, T())};
    const auto n = static_cast<std::size_t>(rig_.dof());
    const std::size_t last = plan_.hand_torque.size() / n - 1;
    const double recorded = static_cast<double>(k) * T() / plan_.hand.tick;
    const auto row = std::min(static_cast<std::size_t>(std::llround(recorded)), last);
    return {target, 0, std::span(plan_.hand_torque).subspan(n * row, n)};
  }

  ForceWish wish(std::size_t k) {
    const bool armed = plan_.force.empty() || plan_.force[std::min(k, plan_.force.size() - 1)];
    if (armed == armed_) return ForceWish::as_it_is;
    armed_ = armed;
    return armed ? ForceWish::arm : ForceWish::cut;
  }

  bool apply_changes() {
    bool changed = false;
    for (; next_ < plan_.changes.size() && plan_.changes[next_].row <= end_.rows; ++next_) {
      apply_change(parameters_, plan_.changes[next_]);
      changed = true;
    }
    return changed;
  }

  const RunPlan& plan_;
  const RunPace& pace_;
  const RowSink& sink_;
  Rig rig_;
  DivergenceWatch watch_;
  Parameters parameters_;
  std::vector<double> row_;
  std::size_t next_ = 0;
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
  if (!change.setting.ends_with("= ")) return apply_setting(p, change.setting);
  const ParameterInfo* info = find_parameter(change.key());
  if (info == nullptr) throw ParameterError(std::string(change.key()) + ": no such key");
  if (const auto* field = std::get_if<double Parameters::*>(&info->field)) p.** field = kFromArm;
}

RunEnd end_of(const Session& session) {
  DivergenceWatch watch(session.layout);
  for (std::size_t k = 0; k < session.size(); ++k) watch.add(session.row(k));
  RunEnd end;
  end.rows = session.size();
  note(end, watch);
  return end;
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
