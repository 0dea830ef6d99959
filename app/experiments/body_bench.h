// Bodies by themselves, tick by tick as the loop steps them, and what their motion is compared to.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/experiments/body_theory.h"
#include "app/experiments/experiment.h"
#include "core/touch/body_world.h"
#include "core/touch/mass_properties.h"
#include "core/touch/scene.h"

namespace limpid {

// A measured value beside the one that theory expects.
struct BodyClaim {
  std::string group;  // on the figure's axis
  std::string what;
  std::string unit;
  std::optional<double> expected;  // none: no theory says it
  double measured = 0;
  double limit = 0;           // of the error: relative [%], or in `unit`
  bool relative = true;       // the error is one of the expected value
  std::string conditions;     // a sentence
  std::string unjudged = {};  // sentence on why it is only measured; else empty

  double error() const;  // more than right is positive; without theory the measured value
  Check check() const;
};

// Findings of a case under one tick.
struct BodyFindings {
  std::vector<BodyClaim> claims;
  std::vector<Series> curves = {};  // for figures
};

struct BodyCase {
  BodyFindings (*find)(double tick);
  bool quick = true;  // takes less than a second
};
std::vector<BodyCase> cases_with_contacts();
std::vector<BodyCase> cases_with_joints();

// "tick 1 ms", as names and sentences have it.
std::string tick_text(double tick);

class BodyBench {
 public:
  BodyBench(const Scene& scene, double tick) : scene_(scene), world_(scene), tick_(tick) {}

  const BodyWorld& world() const { return world_; }
  double time() const { return tick_ * static_cast<double>(ticks_); }  // [s]

  // Bodies never sleep from now on, as those do that the tip is near to.
  void keep_awake() { awake_ = true; }
  // Sets a body going, as far as its joint lets it [m/s, rad/s].
  void set_going(int body, const Vec3& speed, const Vec3& spin) {
    world_.set_speed(body, speed, spin);
  }
  void step();
  void run(double seconds, const std::function<void()>& after_tick = {});

  // Kinetic energy and weight of a body with these moments about its centre, along its own axes
  // [J]; computed here, from its motion alone.
  double energy(int body, const Vec3& moments) const;
  Vec3 angular_momentum(int body, const Vec3& moments) const;  // about its centre [N m s]
  Vec3 own_spin(int body) const;                               // along its own axes [rad/s]

 private:
  const Object& object(int body) const;

  Scene scene_;
  BodyWorld world_;
  double tick_;
  long ticks_ = 0;
  bool awake_ = false;
};

// A body of one shape, without friction of its own.
Object moving(const std::string& name, const Shape& shape, double mass, const Pose& pose);
// Fixed ground below z = 0; on a slope [rad] it falls towards x.
Object ground(double slope, double friction);
Pose turned_at(const Vec3& at, double angle, const Vec3& about);
double radians(double degrees);

}  // namespace limpid
