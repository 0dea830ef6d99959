#include "app/device/axis_check_run.h"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <thread>

#include "core/dynamics/arm.h"
#include "core/realtime/haptic_thread.h"
#include "core/tick/motor_stage.h"
#include "core/tick/motor_warmth.h"
#include "core/tick/safety.h"

namespace limpid {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kCheckTick{1};
constexpr milliseconds kSilence{400};
constexpr double kSmooth = 0.004;  // smoothing of the judged velocity [s]

// The device's safety limits, judged at each tick.
class Limits {
 public:
  using Vector = Vec<kAnyDof>;

  Limits(const ArmDescription& arm, const SafetyLimits& limits)
      : arm_(arm),
        safety_(arm),
        warmth_(arm),
        J_(Jacobian<kAnyDof>::Zero(3, arm.dof())),
        x_(Vector::Zero(arm.dof())),
        v_(Vector::Zero(arm.dof())),
        torque_(Vector::Zero(arm.dof())),
        none_(torque_),
        effort_(of_joints<kAnyDof>(arm, &Joint::effort)) {
    safety_.limit(limits);
  }

  // Judges the device at `x`, T [s] after the last tick; false beyond a limit.
  bool allow(std::span<const double> x, double T) noexcept {
    const Vector now = Eigen::Map<const Vector>(x.data(), x_.size());
    if (!now.allFinite()) return true;  // which ends the check itself
    if (!started_) x_ = now;
    started_ = true;
    const double put_out = torque_.dot(now - x_);
    v_ += T / (kSmooth + T) * ((now - x_) / T - v_);
    x_ = now;
    Arm<kAnyDof>::Frames frames;
    arm_.frames(x_, frames);
    arm_.point_jacobian(frames, arm_.dof() - 1, arm_.tip(frames), J_);
    // The torque is given as none: whether the device moves at all is for the check to judge.
    const Objections against =
        safety_.judge({.guarded = true}, false, {x_, v_, J_, none_, put_out, T});
    return against.ceiling >= 1 && against.fault == ForceState::on;
  }

  // Limits the torque that the motors hold from now on, T [s] after the last one.
  std::span<const double> within(std::span<const double> torque, double T) noexcept {
    warmth_.hold(torque_, T);
    torque_ = TorqueLimits<kAnyDof>(effort_, J_, safety_.tip_force())
                  .within(Eigen::Map<const Vector>(torque.data(), torque_.size()));
    return {torque_.data(), torque.size()};
  }

  const Vector& warmth() const { return warmth_.modelled(); }

 private:
  Arm<kAnyDof> arm_;
  Safety<kAnyDof> safety_;
  MotorWarmth<kAnyDof> warmth_;
  Jacobian<kAnyDof> J_;
  Vector x_, v_, torque_;
  const Vector none_, effort_;  // [N m]
  bool started_ = false;
};

CheckEnd why_not_well(bool here, const DeviceReading& reading) {
  if (!here) return CheckEnd::gone;
  if (!reading.hand) return CheckEnd::open_hand;
  if (reading.fault) return CheckEnd::fault;
  return reading.age <= SafetyLimits::kStaleReading ? CheckEnd::none : CheckEnd::stale;
}

// Notes the first reason.
void note(AxisCheckProgress& progress, CheckEnd why) {
  CheckEnd none = CheckEnd::none;
  progress.end.compare_exchange_strong(none, why);
}

const char* explain(CheckEnd end) {
  switch (end) {
    case CheckEnd::none: return "";
    case CheckEnd::stopped: return " You stopped it.";
    case CheckEnd::no_window:
      return " The window did not answer for 0.4 s, so the check ended and the force was switched "
             "off.";
    case CheckEnd::gone: return " The device was disconnected. Plug the device in again.";
    case CheckEnd::open_hand: return " The device says that no hand holds it.";
    case CheckEnd::fault: return " The device reported a fault.";
    case CheckEnd::stale:
      return " The device gave no reading for 5 ms. Close other programs, or try another port.";
  }
  return "";
}

}  // namespace

AxisCheck run_axis_check(Device& device, const ArmDescription& arm, const SafetyLimits& limits,
                         AxisCheckProgress& progress, const AskForPriority& ask) {
  AxisCheck check(device.traits());
  if (arm.dof() != check.dof()) {
    throw std::invalid_argument(
        "a device can be checked only with an arm of the same number of joints");
  }
  progress.arm = arm;
  progress.begun = true;
  Limits set(arm, limits);
  const auto joints = static_cast<std::size_t>(device.traits().dof);
  std::atomic<bool> done = false;
  std::optional<std::uint32_t> lapses;  // none known before the first tick
  {
    HapticThread thread(ask);
    const auto tick = [&](const TickTiming& timing) {
      if (done) return;
      if (progress.cancel) {
        check.cancel();
        note(progress, CheckEnd::stopped);
      }
      DeviceReading reading;
      const bool here = device.read(reading), first = !lapses;
      const bool gap = health_of(reading, here, true, timing.dt, 0, lapses).gap && !first;
      const CheckEnd ill = why_not_well(here, reading);
      const bool well = ill == CheckEnd::none;
      if (!well) note(progress, ill);
      const std::span<const double> x = std::span(reading.x).first(joints);
      const double T = timing.periods * 1e-3;
      if (well && !set.allow(x, T)) check.exceed();
      device.write(set.within(check.step({x, T, well, gap}), T));
      progress.axis = check.axis();
      progress.stage = check.stage();
      done = check.done();
    };
    thread.start(kCheckTick, tick, Overdue::given_up);
    while (!done && thread.status().running) {
      std::this_thread::sleep_for(milliseconds(10));
      if (std::chrono::steady_clock::now() - progress.window_seen.load() > kSilence) {
        note(progress, CheckEnd::no_window);
        progress.cancel = true;
      }
    }
  }
  device.stop();
  progress.warmth = set.warmth();
  return check;
}

std::string report_of(const AxisCheck& check, CheckEnd end) {
  std::string text;
  for (int i = 0; i < check.dof(); ++i) {
    text +=
        fmt::format("{}axis {}: {}", i == 0 ? "" : "\n", i + 1, explain(check.finding(i).verdict));
  }
  return check.passed() ? text : text + explain(end);
}

}  // namespace limpid
