#include "app/device/identify_run.h"

#include <algorithm>
#include <thread>

#include "core/realtime/haptic_thread.h"
#include "core/tick/motor_warmth.h"
#include "devices/device.h"

namespace limpid {
namespace {

using std::chrono::duration;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kIdentifyTick{1};
constexpr double kT = 1e-3;         // [s]
constexpr double kLongestWay = 30;  // longest way to the middle at the start [s]

double seconds(steady_clock::duration t) { return duration<double>(t).count(); }

// Warmth of cold motors that have held these torques for a tick each, a column a tick.
Eigen::VectorXd warmth_of(const ArmDescription& arm, const Eigen::MatrixXd& torque) {
  MotorWarmth<kAnyDof> motors(arm);
  for (Eigen::Index k = 0; k < torque.cols(); ++k) motors.hold(torque.col(k), kT);
  return motors.modelled();
}

// Data of a run that its ticks write; allocates only when constructed.
class Recording {
 public:
  Recording(const ArmDescription& arm, const DeviceTraits& traits, const ExcitationPlan& plan)
      : arm_(arm), motion_(arm, traits, plan), joints_(static_cast<std::size_t>(traits.dof)) {
    const auto rows = static_cast<Eigen::Index>((motion_.duration() + kLongestWay) / kT);
    x_.resize(traits.dof, rows);
    torque_.resize(traits.dof, rows);
    intervals_.reserve(static_cast<std::size_t>(rows));
  }

  bool running() const { return motion_.end() == ExcitationEnd::running && rows_ < x_.cols(); }
  void cancel() noexcept { motion_.cancel(); }

  // Runs a tick: `periods` since the last one, the time that really passed, `dt` [s], and the
  // watcher's `silence` [s].
  void tick(Device& device, int periods, double dt, double silence) noexcept {
    DeviceReading reading;
    const bool here = device.read(reading);
    note_arrival(reading);
    if (rows_ <= 1) lapses_ = reading.lapses;  // lapses before the first torque do not count
    const DeviceHealth health = health_of(reading, here, true, dt, silence, lapses_);
    const std::span<const double> x = std::span(reading.x).first(joints_);
    // Ticks that were given up: the last torque stayed.
    for (int i = 1; i < periods && rows_ > 0 && rows_ < x_.cols(); ++i, ++rows_) {
      x_.col(rows_) = Eigen::Map<const Eigen::VectorXd>(x.data(), x_.rows());
      torque_.col(rows_) = torque_.col(rows_ - 1);
    }
    const std::span<const double> torque = motion_.step({x, periods * kT, health});
    device.write(torque);
    if (rows_ == x_.cols()) return motion_.cancel();
    x_.col(rows_) = Eigen::Map<const Eigen::VectorXd>(x.data(), x_.rows());
    torque_.col(rows_) = Eigen::Map<const Eigen::VectorXd>(torque.data(), x_.rows());
    ++rows_;
  }

  void tell(IdentifyProgress& progress) const noexcept {
    progress.time = motion_.time();
    progress.duration = motion_.duration();
    progress.stage = motion_.stage();
    progress.joint = motion_.joint();
  }

  IdentifyRun result() {
    IdentifyRun run{.end = motion_.end(),
                    .objection = motion_.objection(),
                    .joint = motion_.joint(),
                    .record = {.T = kT,
                               .x = x_.leftCols(rows_).transpose(),
                               .torque = torque_.leftCols(rows_).transpose()},
                    .warmth = warmth_of(arm_, torque_.leftCols(rows_)),
                    .timing = {}};
    ReadingTimes& timing = run.timing;
    timing.intervals = std::move(intervals_);
    if (timing.intervals.empty()) return run;
    std::vector<double> sorted = timing.intervals;
    std::ranges::sort(sorted);
    const auto at = [&](double part) {
      return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
    };
    timing.p50 = at(0.5), timing.p99 = at(0.99), timing.most = at(1);
    timing.rate = static_cast<double>(readings_) / std::max(heard_, kT);
    return run;
  }

 private:
  // Notes when the newest reading came, from its age.
  void note_arrival(const DeviceReading& reading) noexcept {
    const double now = seconds(steady_clock::now().time_since_epoch());
    const double arrived = now - reading.age;
    if (count_ > 0 && reading.count > count_) {
      readings_ += reading.count - count_;
      heard_ += arrived - arrived_;
      if (reading.count == count_ + 1 && intervals_.size() < intervals_.capacity()) {
        intervals_.push_back(arrived - arrived_);
      }
    }
    if (reading.count == count_) return;
    count_ = reading.count;
    arrived_ = arrived;
  }

  ArmDescription arm_;
  Excitation motion_;
  std::size_t joints_;
  Eigen::MatrixXd x_, torque_;  // a column a tick
  Eigen::Index rows_ = 0;
  std::uint64_t count_ = 0, readings_ = 0;
  std::optional<std::uint32_t> lapses_;
  double arrived_ = 0, heard_ = 0;
  std::vector<double> intervals_;
};

}  // namespace

ExcitationPlan within(ExcitationPlan plan, const SafetyLimits& limits) {
  for (const auto& limit : kSafetyLimits) {
    set_number(limit, plan.limits,
               std::min(number_of(limit, plan.limits), number_of(limit, limits)));
  }
  // Overshoot stays within the limit as well.
  plan.range = std::min(plan.range, ExcitationPlan{}.range * plan.limits.range);
  return plan;
}

IdentifyRun run_identification(Device& device, const ArmDescription& arm,
                               const ExcitationPlan& plan, IdentifyProgress& progress,
                               const AskForPriority& ask) {
  Recording recording(arm, device.traits(), plan);
  std::atomic<bool> done = false;
  {
    HapticThread thread(ask);
    const auto tick = [&](const TickTiming& timing) {
      if (done) return;
      if (progress.cancel) recording.cancel();
      recording.tick(device, timing.periods, timing.dt,
                     seconds(steady_clock::now() - progress.seen.load()));
      recording.tell(progress);
      done = !recording.running();
    };
    progress.see();
    thread.start(kIdentifyTick, tick, Overdue::given_up);
    while (!done && thread.status().running) std::this_thread::sleep_for(milliseconds(10));
  }
  device.stop();
  return recording.result();
}

IdentifyRun simulate_identification(Device& device, const ArmDescription& arm,
                                    const ExcitationPlan& plan, IdentifyProgress& progress) {
  Recording recording(arm, device.traits(), plan);
  while (recording.running()) {
    if (progress.cancel) recording.cancel();
    recording.tick(device, 1, kT, 0);
    recording.tell(progress);
  }
  IdentifyRun run = recording.result();
  run.timing = {};
  return run;
}

}  // namespace limpid
