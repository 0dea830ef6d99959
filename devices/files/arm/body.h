// Masses that move together.
#pragma once

#include "core/dynamics/arm_description.h"

namespace limpid {

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

}  // namespace limpid
