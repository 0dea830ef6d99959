// From urdfdom's tree of links to the chain that the loop computes with.
#pragma once

#include <urdf_model/model.h>

#include <vector>

#include "core/dynamics/arm_description.h"
#include "devices/files/urdf_values.h"
#include "devices/files/urdf_visuals.h"

namespace limpid {

// Masses that move together.

inline bool slides(const Joint& joint) { return joint.kind == Joint::Kind::prismatic; }

// A point mass at r about the origin [kg m^2].
inline Mat3 point_inertia(double mass, const Vec3& r) {
  return mass * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
}

// About the origin of the link's frame [kg m^2].
inline Mat3 about_origin(const Link& link) {
  return link.inertia + point_inertia(link.mass, link.com);
}

// Adds a body to `link`; `at` is the body's frame in the link's.
inline void merge(Link& link, const Link& body, const Pose& at) {
  const Vec3 there = at * body.com;
  const double mass = link.mass + body.mass;
  const Vec3 com = mass > 0 ? Vec3((link.mass * link.com + body.mass * there) / mass) : link.com;
  link.inertia += point_inertia(link.mass, link.com - com) +
                  at.linear() * body.inertia * at.linear().transpose() +
                  point_inertia(body.mass, there - com);
  link.mass = mass;
  link.com = com;
}

// Arms that are described in full and yet cannot move.

// Warns of joints whose friction holds against their own motor, of joints with hardly any range,
// and of a tip that no joint moves: what was found, and what to change.
void warn_of_immobile(const ArmDescription& arm, UrdfPlaces& places);

// Chains that end in links without any mass.

// Nothing holds back a joint beyond which nothing has mass: no torque could. Such joints at the end
// of the chain are held still, at 0 or the limit next to it, with a warning, and what they moved is
// fixed to the last link that has mass; the tip stays the tip. The first joint is left.
void shorten_to_mass(ArmDescription& arm, UrdfPlaces& places);

// The joints of `way` that move, and everything else held still and merged into the links that they
// move. What is missing and can be guessed is, with a warning.
// Errors: FileError, as read_urdf.
ArmDescription chain_of(const urdf::ModelInterface& model,
                        const std::vector<urdf::JointConstSharedPtr>& way,
                        const LinkShapes& visuals, UrdfPlaces& places);

}  // namespace limpid
