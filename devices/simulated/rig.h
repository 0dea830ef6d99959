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

// What reaches the loop from outside in one tick.
struct RigInput {
  HandInput hand;
  ForceRequest force = ForceRequest::as_it_is;
  int periods = 1;     // since the step before, in ticks
  double dt = 0;       // the same as it really passed [s]; 0: as long as it should be
  double silence = 0;  // since the window last answered [s]
};

// A starting point of any size, e.g. the first row of a recording.
struct RigStart {
  Eigen::VectorXd x1, v1, x2, v2;  // [rad, rad/s]
  Eigen::VectorXd f1_hat;          // [N m]
  Vec3 target = Vec3::Zero();      // where the hand wants the tip [m]
  bool armed = true;               // at full force at once; a guarded device never is
  // What laws that account for it may still give the hand; they start with no more [J].
  double reserve = std::numeric_limits<double>::infinity();
  // Of all bodies, as the loop keeps them; empty: as the scene has them.
  std::vector<double> world{};
};

// What a rig's arm can touch, ready to be taken in by a running loop.
class TouchWorld {
 public:
  // Not for the haptic thread. Every mesh of the scene has its shape.
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
  // With a simulated device for the arm.
  Rig(const ArmDescription& arm, const Scene& scene);
  // With this one; without one it counts as lost.
  Rig(const ArmDescription& arm, const Scene& scene, Device* device);
  ~Rig();
  Rig(Rig&&) noexcept;
  Rig& operator=(Rig&&) noexcept;

  // From the next step on; null: as if none was ever plugged in. The caller keeps it.
  void plug(Device* device) noexcept;
  // What the device said at the last step; false if it was not there.
  bool device_reading(DeviceReading& newest) const;

  int dof() const { return layout().dof(); }
  const RowLayout& layout() const;

  // Force of a guarded device is off then, until it is armed.
  void start(const Parameters& p, const RigStart& start);
  // Where it stands now, as a starting point. `into` has vectors of this size already: nothing is
  // allocated.
  void present(RigStart& into) const;
  // Begins anew from where it stands, the force as it is: so does a recording of a running loop.
  // `scratch` as in present(); `target` is the hand's [m].
  void restart_here(const Parameters& p, RigStart& scratch, const Vec3& target);
  void limit(const SafetyLimits& limits);
  // Between two steps: takes in what can be touched from now on, made for the same arm, and gives
  // out what could be until now. Contacts with meshes that stay remember their sides.
  void exchange(TouchWorld& world) noexcept;
  // Reads the device, runs the tick, lives through it; writes the row (not its timing). Allocates
  // nothing.
  void step(const Parameters& p, const RigInput& input, std::span<double> row) noexcept;

  Vec3 tip() const;       // of the device [m]
  bool steady() const;    // nothing fades, no coupling is being switched
  bool diverged() const;  // the loop went unstable; force is off
  const ForceGate& force() const;
  ForceState force_state() const { return force().why(); }

 private:
  template <int N>
  struct Of;
  std::variant<std::unique_ptr<Of<3>>, std::unique_ptr<Of<7>>, std::unique_ptr<Of<kAnyDof>>> of_;
};

// At rest, the tip on `target`. Throws std::invalid_argument if it cannot be reached.
RigStart rest_at(const ArmDescription& arm, const Vec3& target);
// What the first row of a recording says.
RigStart start_of(const RowLayout& layout, std::span<const double> row);

}  // namespace limpid
