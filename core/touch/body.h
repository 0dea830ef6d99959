// Properties of objects that move, besides shape, place and material: plain data, SI.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/math/sizes.h"

namespace limpid {

// Largest number of bodies in a scene.
inline constexpr int kMostBodies = 64;

// A force along a joint that depends on the joint's place alone: it neither takes nor makes energy.
struct JointForce {
  double spring = 0;           // towards `rest` [N/m] or [N m/rad]
  double rest = 0;             // [m] or [rad]
  double detent_force = 0;     // amplitude of a periodic force, against s [N] or [N m]
  double detent_period = 0.1;  // its period; s = 0 is a place of rest [m] or [rad]
  // Table of forces against s, over s: linear between the points, constant outside. [m, N] or [rad,
  // N m].
  std::vector<std::array<double, 2>> travel;
  friend bool operator==(const JointForce&, const JointForce&) = default;
};

// Joint of a body with another one or the world.
struct BodyJoint {
  enum class Kind : std::uint8_t { slider, hinge, ball };

  Kind kind = Kind::slider;
  std::string to;             // another body's name; empty: the world
  Vec3 axis = Vec3::UnitZ();  // axis of a slider or a hinge, unit, at the start, in the world
  Vec3 point = Vec3::Zero();  // point of a hinge or a ball, in the body's frame [m]
  // Stops [m] or [rad]; 0 is the pose at the start.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  double stop_stiffness = 20000;  // [N/m] or [N m/rad]
  double stop_restitution = 0;    // [-]
  double damping = 0;             // [N s/m] or [N m s/rad]
  double friction = 0;            // dry [N] or [N m]
  JointForce force;
  friend bool operator==(const BodyJoint&, const BodyJoint&) = default;
};

// Mass and related properties of a body.
struct Body {
  double mass = 0.05;  // [kg]
  // Centre of mass in the object's frame [m], and principal moments about it along the frame's axes
  // [kg m^2]. Default: those of a solid of the shape, of uniform density.
  std::optional<Vec3> center{};
  std::optional<Vec3> inertia{};
  double contact_stiffness = 20000;  // in contacts with other bodies and fixed objects [N/m]
  double restitution = 0;            // in these contacts [-]
  bool magnet = false;               // the device's button or a key can pick it up
  std::optional<BodyJoint> joint{};
  friend bool operator==(const Body&, const Body&) = default;
};

// A spring and damper between two bodies, or a body and the world.
struct BodySpring {
  std::array<std::string, 2> between;  // names; the second may be empty: the world
  // Points where it is fixed, each in its body's frame [m].
  std::array<Vec3, 2> points{Vec3::Zero(), Vec3::Zero()};
  double length = 0;                                           // at rest [m]
  double stiffness = 100;                                      // [N/m]
  double damping = 0;                                          // [N s/m]
  double breaks_at = std::numeric_limits<double>::infinity();  // [N]
  friend bool operator==(const BodySpring&, const BodySpring&) = default;
};

// A pull on a body from outside, as with the mouse in the picture.
struct BodyPull {
  int body = -1;               // as BodyWorld counts them; -1: none
  Vec3 point = Vec3::Zero();   // point of the body, in its object's frame [m]
  Vec3 target = Vec3::Zero();  // position that it is pulled to [m]
  friend bool operator==(const BodyPull&, const BodyPull&) = default;
};

}  // namespace limpid
