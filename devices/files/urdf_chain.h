// The chain that the loop computes with, made from urdfdom's tree of links.
#pragma once

#include <urdf_model/model.h>

#include <vector>

#include "core/dynamics/arm_description.h"
#include "devices/files/urdf_values.h"
#include "devices/files/urdf_visuals.h"

namespace limpid {

inline bool slides(const Joint& joint) { return joint.kind == Joint::Kind::prismatic; }

// Inertia of a point mass at r about the origin [kg m^2].
inline Mat3 point_inertia(double mass, const Vec3& r) {
  return mass * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
}

// Inertia of a link about the origin of its frame [kg m^2].
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

// Warns of arms that are described in full and yet cannot move, and says what to change: joints
// whose friction resists their own motor, joints with hardly any range, a tip that no joint moves.
void warn_of_immobile(const ArmDescription& arm, UrdfPlaces& places);

// Holds joints at the chain's end still if nothing beyond them has mass, as no torque could control
// them. They stay at 0 or the limit next to it, with a warning. What they moved is fixed to the
// last link with mass; the tip stays the tip. The first joint is left.
void shorten_to_mass(ArmDescription& arm, UrdfPlaces& places);

// The arm of the moving joints of `way`. All other joints are held still, and their links merged
// into the links that move them. Missing data that can be guessed is guessed, with a warning.
// Errors: FileError, as read_urdf().
ArmDescription chain_of(const urdf::ModelInterface& model,
                        const std::vector<urdf::JointConstSharedPtr>& way,
                        const LinkShapes& visuals, UrdfPlaces& places);

}  // namespace limpid
