// What an object that moves has besides a shape, a place and a material: plain data, SI.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/math/sizes.h"

namespace limpid {

// As many as a scene may have.
inline constexpr int kMostBodies = 64;

// A force along a joint that only depends on where the joint is: it keeps no energy and makes none.
struct JointForce {
  double spring = 0;           // towards `rest` [N/m] or [N m/rad]
  double rest = 0;             // [m] or [rad]
  double detent_force = 0;     // amplitude of a force that changes its sign twice a period [N] or
  double detent_period = 0.1;  // [N m], against s; a place of rest at s = 0 [m] or [rad]
  // Force against s, over s, straight between the points; outside as at the ends. [m, N] or
  // [rad, N m].
  std::vector<std::array<double, 2>> travel;
  friend bool operator==(const JointForce&, const JointForce&) = default;
};

// How a body hangs on another one or on the world.
struct BodyJoint {
  enum class Kind : std::uint8_t { slider, hinge, ball };

  Kind kind = Kind::slider;
  std::string to;             // another body's name; empty: the world
  Vec3 axis = Vec3::UnitZ();  // unit, of a slider or a hinge, at the start, in the world
  Vec3 point = Vec3::Zero();  // of a hinge or a ball, in the body's frame [m]
  // Where it stops [m] or [rad]; 0 is the pose at the start.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  double stop_stiffness = 20000;  // [N/m] or [N m/rad]
  double stop_restitution = 0;    // [-]
  double damping = 0;             // [N s/m] or [N m s/rad]
  double friction = 0;            // dry [N] or [N m]
  JointForce force;
  friend bool operator==(const BodyJoint&, const BodyJoint&) = default;
};

// Mass and what goes with it.
struct Body {
  double mass = 0.05;  // [kg]
  // Of mass, in the object's frame [m]; principal moments about it, along the frame's axes
  // [kg m^2]. Default: of a solid of the shape, of the same density everywhere.
  std::optional<Vec3> center{};
  std::optional<Vec3> inertia{};
  double contact_stiffness = 20000;  // with other bodies and with what stands still [N/m]
  double restitution = 0;            // in contacts with them [-]
  bool magnet = false;               // the device's button or a key picks it up
  std::optional<BodyJoint> joint{};
  friend bool operator==(const Body&, const Body&) = default;
};

// A spring and damper between two bodies, or a body and the world.
struct BodySpring {
  std::array<std::string, 2> between;  // names; the second may be empty: the world
  // Where it holds, each in its body's frame [m].
  std::array<Vec3, 2> points{Vec3::Zero(), Vec3::Zero()};
  double length = 0;                                           // at rest [m]
  double stiffness = 100;                                      // [N/m]
  double damping = 0;                                          // [N s/m]
  double breaks_at = std::numeric_limits<double>::infinity();  // [N]
  friend bool operator==(const BodySpring&, const BodySpring&) = default;
};

// Somebody pulls on a body from outside, as with the mouse in the picture.
struct BodyPull {
  int body = -1;               // as BodyWorld counts them; -1: none
  Vec3 point = Vec3::Zero();   // of it, in its object's frame [m]
  Vec3 target = Vec3::Zero();  // where it is pulled to [m]
  friend bool operator==(const BodyPull&, const BodyPull&) = default;
};

}  // namespace limpid
