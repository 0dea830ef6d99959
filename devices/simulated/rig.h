// A device, the loop that drives it and the hand that holds it: one step is one tick of all three.
//
// Live threads, headless runs, re-runs and tests all call the same step.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "core/tick/arming.h"
#include "core/tick/row.h"
#include "core/tick/safety_limits.h"
#include "core/touch/scene.h"
#include "devices/device.h"

namespace limpid {

template <int N>
class Contacts;

// Input of the loop from outside in one tick.
struct RigInput {
  HandInput hand;
  ForceRequest force = ForceRequest::as_it_is;
  int periods = 1;     // ticks since the step before
  double dt = 0;       // time that really passed since then [s]; 0: as long as it should be
  double silence = 0;  // time since the window last answered [s]
  // Force that the motors are to make at the tip besides, to measure the grip [N].
  Vec3 excitation = Vec3::Zero();
};

// A starting point of any size, e.g. the first row of a recording.
struct RigStart {
  Eigen::VectorXd x1, v1, x2, v2;  // [rad, rad/s]
  Eigen::VectorXd f1_hat;          // [N m]
  Vec3 target = Vec3::Zero();      // where the hand wants the tip [m]
  bool armed = true;               // at full force at once; a guarded device never is
  // Energy that laws which account for it may still give the hand; they start with at most this
  // [J].
  double reserve = std::numeric_limits<double>::infinity();
  // State of all bodies, as the loop keeps it; empty: as the scene has them.
  std::vector<double> world{};
  bool owed = false;  // the hand has not put in the energy that is stored
  // Warmth of each motor by the arm's model [-]; empty: cold.
  Eigen::VectorXd warmth{};
};

// Everything that a rig's arm can touch, prepared for a running loop to take in.
class TouchWorld {
 public:
  // Not for the haptic thread: builds everything. Precondition: every mesh of the scene has its
  // shape.
  TouchWorld(const ArmDescription& arm, const Scene& scene);
  ~TouchWorld();
  TouchWorld(TouchWorld&&) noexcept;
  TouchWorld& operator=(TouchWorld&&) noexcept;

 private:
  friend class Rig;
  std::variant<std::unique_ptr<Contacts<3>>, std::unique_ptr<Contacts<7>>,
               std::unique_ptr<Contacts<kAnyDof>>>
      contacts_;
};

class Rig {
 public:
  // Makes a rig with a simulated device for the arm.
  Rig(const ArmDescription& arm, const Scene& scene);
  // Makes a rig with this device; null counts as a lost one.
  Rig(const ArmDescription& arm, const Scene& scene, Device* device);
  ~Rig();
  Rig(Rig&&) noexcept;
  Rig& operator=(Rig&&) noexcept;

  // Uses `device` from the next step on; null: the rig's own device. The caller keeps it.
  void plug(Device* device) noexcept;
  // Gives the device's reading at the last step; false if the device was not there.
  bool device_reading(DeviceReading& newest) const;

  int dof() const { return layout().dof(); }
  const RowLayout& layout() const;

  // Starts there. The force of a guarded device is off until it is armed.
  void start(const Parameters& p, const RigStart& start);
  // Writes the rig's present state as a starting point. Allocates nothing if the vectors of `into`
  // already have their size.
  void present(RigStart& into) const;
  // Begins anew where the rig stands, with the force as it is: recordings of a running loop begin
  // so. `scratch` is as `into` of present(); `target` is the hand's [m].
  void restart_here(const Parameters& p, RigStart& scratch, const Vec3& target);
  void limit(const SafetyLimits& limits);
  // Exchanges what can be touched, between two steps: takes in `world`, made for the same arm, and
  // gives out the one until now. Contacts with meshes that stay remember their sides.
  void exchange(TouchWorld& world) noexcept;
  // Reads the device, runs the tick, gives the device its torque, and writes the row (without its
  // timing). Allocates nothing.
  void step(const Parameters& p, const RigInput& input, std::span<double> row) noexcept;

  Vec3 tip() const;       // of the device [m]
  bool steady() const;    // nothing fades and no coupling is being switched
  bool diverged() const;  // the loop went unstable; force is off
  const ForceGate& force() const;
  ForceState force_state() const { return force().why(); }

 private:
  template <int N>
  struct Of;
  std::variant<std::unique_ptr<Of<3>>, std::unique_ptr<Of<7>>, std::unique_ptr<Of<kAnyDof>>> of_;
};

// A start at rest with the tip on `target`. Throws std::invalid_argument if it cannot be reached.
RigStart rest_at(const ArmDescription& arm, const Vec3& target);
// The start that the first row of a recording says.
RigStart start_of(const RowLayout& layout, std::span<const double> row);

}  // namespace limpid
