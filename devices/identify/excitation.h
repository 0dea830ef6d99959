// Motion of a device by its own motors for identification. Each joint in turn makes a slow sweep
// (friction), then all move at many frequencies (inertia, gravity, delay).
//
// A gentle controller follows a path about the middle of the range. Its torque passes the same
// stages as the loop's: arming and fading, the safety limits, the slew. An objection of theirs, a
// hand that holds on, or a joint that does not follow ends the motion for good.
//
// Use, at every tick and with nothing else pushing:
//
//   Excitation motion(arm, device.traits(), plan);
//   device.write(motion.step({reading.x, T, health}));
//
// until motion.end() is no longer `running`; the torque then stays zero.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/arm.h"
#include "core/tick/motor_stage.h"
#include "core/tick/safety.h"
#include "devices/device.h"

namespace limpid {

enum class ExcitationEnd : std::uint8_t {
  running,
  complete,
  cancelled,
  not_well,  // the device is lost, silent or at fault, or the loop stood still
  let_go,    // the dead-man switch opened
  limit,     // too fast, too far, or too much energy
  held,      // a joint does not follow: something holds it
};
const char* explain(ExcitationEnd end);  // for people, a sentence

enum class ExcitationStage : std::uint8_t { approach, sweep, shake, fade };

struct ExcitationPlan {
  double range = 0.6;      // part of each joint's range that is used
  double torque = 0.6;     // part of each joint's torque limit
  double amplitude = 0.5;  // largest, to either side [rad]
  double sweep = 6;        // duration for each joint [s]
  double shake = 24;       // duration for all joints together [s]
  SafetyLimits limits{.joint_speed = 12, .tip_speed = 1.5, .tip_force = 6, .energy = 1, .range = 1};
};

class Excitation {
 public:
  struct Tick {
    std::span<const double> x;  // positions of the joints [rad]
    double T = 0.001;           // time since the last tick [s]
    DeviceHealth health;
  };

  // Guesses the device's inertia from the arm: a factor of two either way does no harm. Throws
  // std::invalid_argument if the device has no motors, or other joints than the arm.
  Excitation(const ArmDescription& arm, const DeviceTraits& traits, const ExcitationPlan& plan);

  // Returns the torque to be held until the next tick [N m]. Allocates nothing.
  std::span<const double> step(const Tick& in) noexcept;
  void cancel() noexcept { finish(ExcitationEnd::cancelled); }

  ExcitationEnd end() const { return end_; }
  ExcitationStage stage() const { return stage_; }
  ForceState objection() const { return gate_.why(); }
  int joint() const { return joint_; }  // the joint being swept, or the one that did not follow
  double duration() const { return duration_; }  // of the whole motion [s]
  double time() const { return time_; }          // since its start [s]

 private:
  using Vector = Vec<kAnyDof>;
  static constexpr int kTones = 6;

  void finish(ExcitationEnd end) noexcept;
  void begin(const Vector& x) noexcept;
  Vector wanted(double time) noexcept;
  bool follows(const Vector& error, const Vector& torque, double T) noexcept;
  double reach(Eigen::Index joint, double t) const noexcept;
  void moderate(const Jacobian<kAnyDof>& J);

  Arm<kAnyDof> arm_;
  ExcitationPlan plan_;
  Vector middle_, amplitude_, limit_, stiffness_, damping_;
  std::array<std::array<double, kTones>, kMaxDof> frequency_{}, share_{};
  double approach_ = 0, duration_ = 0;

  Safety<kAnyDof> safety_;
  MotorStage<kAnyDof> motors_;
  ForceGate gate_;
  ExcitationEnd end_ = ExcitationEnd::running;
  ExcitationStage stage_ = ExcitationStage::approach;
  int joint_ = 0;
  double time_ = 0;
  bool started_ = false, was_on_ = false;
  Vector start_, x_, v_, wish_, sum_, away_, torque_;
};

}  // namespace limpid
