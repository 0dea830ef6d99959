// Moves a device by its own motors so that it shows what it is: each joint in turn through a slow
// sweep (friction), then all at once through many frequencies (inertia, gravity, delay).
//
// A gentle controller follows a path about the middle of the range; the torque passes the same
// stages as the loop's own: arming and fading, the limits of safety, the slew. Whatever they object
// to, a hand that holds on, and a joint that does not follow end it, and nothing goes on from
// there.
//
// To drive it, at every tick and with nothing else pushing:
//
//   Excitation motion(arm, device.traits(), plan);
//   device.write(motion.step({reading.x, T, health}));
//
// until motion.end() is no longer `running`: the torque is zero for good.
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
  not_well,  // the device: lost, silent, at fault, or the loop stood still
  let_go,    // its dead-man switch opened
  limit,     // too fast, too far, or too much energy
  held,      // something holds it: it does not follow
};
const char* explain(ExcitationEnd end);  // for people, a sentence

enum class ExcitationStage : std::uint8_t { approach, sweep, shake, fade };

struct ExcitationPlan {
  double range = 0.6;      // part of each joint's range that is used
  double torque = 0.6;     // part of each joint's limit
  double amplitude = 0.5;  // most, to either side [rad]
  double sweep = 6;        // of each joint [s]
  double shake = 24;       // of all joints [s]
  SafetyLimits limits{.joint_speed = 12, .tip_speed = 1.5, .tip_force = 6, .energy = 1, .range = 1};
};

class Excitation {
 public:
  struct Tick {
    std::span<const double> x;  // positions of the joints [rad]
    double T = 0.001;           // since the last tick [s]
    DeviceHealth health;
  };

  // Its inertia is guessed from the arm: a factor of two either way does no harm.
  // Throws std::invalid_argument if it has no motors, or other joints than the arm.
  Excitation(const ArmDescription& arm, const DeviceTraits& traits, const ExcitationPlan& plan);

  // The torque to be held until the next tick [N m]. Allocates nothing.
  std::span<const double> step(const Tick& in) noexcept;
  void cancel() noexcept { finish(ExcitationEnd::cancelled); }

  ExcitationEnd end() const { return end_; }
  ExcitationStage stage() const { return stage_; }
  ForceState objection() const { return gate_.why(); }
  int joint() const { return joint_; }           // being swept, or the one that did not follow
  double duration() const { return duration_; }  // all of it [s]
  double time() const { return time_; }          // gone of it [s]

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
