#include "app/run/body_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/dynamics/farthest_tip.h"
#include "core/touch/body_geometry.h"
#include "core/touch/body_motion.h"
#include "core/touch/contacts.h"
#include "core/touch/mass_properties.h"
#include "core/touch/triangle_mesh.h"

namespace limpid {
namespace {

constexpr double kInEachOther = 0.0005;  // less than this deep is touching [m]
constexpr double kHurts = 0.2;           // [J]
constexpr double kFarFetched = 100;      // times the inertia of a solid

// Returns the box around a mesh, in its object's frame: a box at a pose.
std::pair<Box, Pose> box_around(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  if (mesh.triangles) {
    for (std::size_t i = 0; i < mesh.triangles->triangles(); ++i) {
      for (const Vec3& corner : mesh.triangles->corners(i)) box.extend(corner);
    }
  }
  if (box.isEmpty()) return {Box{Vec3::Zero()}, Pose::Identity()};
  const Vec3 middle = mesh.size() * (box.center() + mesh.triangles->middle());
  return {Box{mesh.size() * box.sizes()}, mesh.stood(Pose::Identity()) * pose_at(middle)};
}

struct Placed {
  Shape shape;
  Pose pose;
};

// Returns shape and parts in the world; a mesh as the box around it.
std::vector<Placed> pieces(const Object& object) {
  std::vector<Placed> all{{object.shape, object.pose}};
  if (const auto* mesh = std::get_if<Mesh>(&object.shape)) {
    const auto [box, at] = box_around(*mesh);
    all[0] = {box, object.pose * at};
  }
  for (const BodyPart& part : object.parts) all.push_back({part.shape, object.pose * part.pose});
  return all;
}

double half_width(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return box->size.minCoeff() / 2;
  if (const auto* ball = std::get_if<Sphere>(&shape)) return ball->radius;
  if (const auto* c = std::get_if<Cylinder>(&shape)) return std::min(c->radius, c->length / 2);
  if (const auto* k = std::get_if<Capsule>(&shape)) return k->radius;
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    return box_around(*mesh).first.size.minCoeff() / 2;
  }
  static_assert(kShapes == 7);
  return 0;
}

Vec3 root_of(const ArmDescription& arm) {
  return arm.joints.empty() ? Vec3(Vec3::Zero()) : Vec3(arm.joints.front().origin.translation());
}

// Returns the height above the origin at which falling things come to rest.
double floor_of(const Scene& scene, const ArmDescription& arm, const Vec3& up) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Object& object : scene.objects) {
    const auto* plane = std::get_if<Plane>(&object.shape);
    if (plane == nullptr || plane->normal.dot(up) < 0.7) continue;
    lowest = std::min(lowest, up.dot(object.pose.translation()));
  }
  if (std::isfinite(lowest)) return lowest;
  return up.dot(root_of(arm)) - farthest_tip(arm).distance;
}

// Returns how far a joint on the world lets a centre of mass sink; one on a body sinks with that.
double sinks_on(const BodyJoint& joint, const Object& object, const Vec3& center, const Vec3& up) {
  const double along = joint.axis.dot(up);
  if (joint.kind == BodyJoint::Kind::slider) {
    const double down = along > 0 ? -joint.low : joint.high;
    return along == 0 ? 0 : std::max(0.0, std::abs(along) * down);
  }
  const Vec3 point = object.pose * joint.point;
  const Vec3 arm = center - point;
  if (joint.kind == BodyJoint::Kind::ball) return up.dot(arm) + arm.norm();
  const Vec3 across = arm - joint.axis.dot(arm) * joint.axis;
  return up.dot(across) + across.norm() * std::sqrt(std::max(0.0, 1 - along * along));
}

std::string line_of(const Object& object) {
  const Body& body = *object.body;
  std::string text = fmt::format("  {:<24} {:>9.4g} kg", object.name, body.mass);
  if (!object.parts.empty()) text += fmt::format(", {} more parts", object.parts.size());
  if (body.joint) {
    constexpr std::array kKinds{"slides", "turns", "hangs"};
    text += fmt::format(", {} on {}", kKinds[static_cast<std::size_t>(body.joint->kind)],
                        body.joint->to.empty() ? "the world" : "'" + body.joint->to + "'");
  }
  if (body.magnet) text += ", the magnet picks it up";
  return text;
}

void warn_of_inertia(const Object& object, const Vec3& i, BodyReport& report) {
  if (!possible_inertia(i)) {
    report.warnings.push_back(
        fmt::format("'{}': an inertia of [{:.4g}, {:.4g}, {:.4g}] kg m^2 is impossible: each "
                    "moment must be at most the sum of the other two",
                    object.name, i.x(), i.y(), i.z()));
    return;
  }
  // Mass at the ends of a rod has three times the inertia of the rod.
  const MassProperties solid = solid_mass_properties(object, 1);
  const double usual = object.body->mass * solid.inertia.diagonal().maxCoeff() / solid.mass;
  if (i.maxCoeff() > kFarFetched * usual) {
    report.warnings.push_back(
        fmt::format("'{}': an inertia of {:.3g} kg m^2 is {:.0f} times that of a solid with the "
                    "same shape and mass; are the moments given in kg m^2?",
                    object.name, i.maxCoeff(), i.maxCoeff() / usual));
  }
}

void warn(const Object& object, const Scene& scene, const ArmDescription& arm, BodyReport& report) {
  const double reach = farthest_tip(arm).distance;
  const double away = beyond_reach(object, scene, arm);
  if (away > 0) {
    report.warnings.push_back(fmt::format("'{}' lies {:.3g} m outside the tip's reach of {:.3g} m",
                                          object.name, away, reach));
  }
  if (object.body->inertia) warn_of_inertia(object, *object.body->inertia, report);
}

// Returns the energy of a spring at the start [J].
double drawn_energy(const BodySpring& spring, const Scene& scene) {
  const auto at = [&](std::size_t end) -> Vec3 {  // in the world
    const auto body = std::ranges::find(scene.objects, spring.between[end], &Object::name);
    if (spring.between[end].empty() || body == scene.objects.end()) return spring.points[end];
    return body->pose * spring.points[end];
  };
  const double drawn = (at(0) - at(1)).norm() - spring.length;
  return spring.stiffness * drawn * drawn / 2;
}

// The same of the spring in an object's joint.
double drawn_energy(const Object& object) {
  if (!object.body || !object.body->joint) return 0;
  const JointForce& force = object.body->joint->force;
  return force.spring * force.rest * force.rest / 2;
}

bool hangs_on(const Object& object, const Object& other) {
  return object.body && object.body->joint && object.body->joint->to == other.name;
}

bool in_a_mechanism(const Object& object, const Scene& scene) {
  const auto& joint = object.body->joint;
  if (joint && (!joint->to.empty() || joint->kind == BodyJoint::Kind::ball)) return true;
  return std::ranges::any_of(scene.objects,
                             [&](const Object& other) { return hangs_on(other, object); });
}

}  // namespace

bool possible_inertia(const Vec3& inertia) {
  return 2 * inertia.maxCoeff() <= (1 + 1e-9) * inertia.sum();
}

double beyond_reach(const Object& object, const Scene& scene, const ArmDescription& arm) {
  const Vec3 root = root_of(arm);
  double least = std::numeric_limits<double>::infinity();
  for (const Placed& piece : pieces(object)) {
    std::visit(
        [&]<class S>(const S& shape) {
          if constexpr (!std::is_same_v<S, Mesh> && !std::is_same_v<S, JointStop>) {
            least = std::min(least, distance_to(shape, piece.pose, root).distance);
          }
        },
        piece.shape);
  }
  return least - farthest_tip(arm).distance - scene.tip_radius;
}

double spring_energy(const Scene& scene) {
  double energy = 0;
  for (const BodySpring& spring : scene.springs) energy += drawn_energy(spring, scene);
  for (const Object& object : scene.objects) energy += drawn_energy(object);
  return energy;
}

std::vector<std::string> quick_mechanisms(const Scene& scene, double tick) {
  std::vector<std::string> warnings;
  for (const Object& object : scene.objects) {
    if (!object.body || !in_a_mechanism(object, scene)) continue;
    double energy = drawn_energy(object);
    for (const Object& other : scene.objects) {
      if (hangs_on(other, object)) energy += drawn_energy(other);
    }
    for (const BodySpring& spring : scene.springs) {
      if (std::ranges::count(spring.between, object.name) > 0) {
        energy += drawn_energy(spring, scene);
      }
    }
    const double least = mass_properties(object).inertia.diagonal().minCoeff();
    const double turn = tick * std::sqrt(2 * energy / least);
    if (!(turn > BodyMotion::kMostTurn)) continue;
    warnings.push_back(
        fmt::format("'{}': its springs store {:.3g} J at the start, and may turn its inertia of "
                    "{:.3g} kg m^2 by {:.3g} rad in a tick of {:.3g} ms; a body of a mechanism "
                    "turns by at most {:.3g} rad in a tick, and loses the rest of the turn",
                    object.name, energy, least, turn, 1e3 * tick, BodyMotion::kMostTurn));
  }
  return warnings;
}

double most_weight_energy(const Scene& scene, const ArmDescription& arm) {
  const double g = scene.gravity.norm();
  if (!(g > 0) || count_bodies(scene) == 0) return 0;
  const Vec3 up = -scene.gravity / g;
  const double floor = floor_of(scene, arm, up);
  double energy = 0;
  for (const Object& object : scene.objects) {
    if (!object.body) continue;
    const Vec3 center = object.pose * mass_properties(object).center;
    // The middle of a body of several parts may come down to the floor, and lie outside of them.
    const double rests = object.parts.empty() ? half_width(object.shape) : 0;
    double sinks = std::max(0.0, up.dot(center) - floor - rests);
    if (object.body->joint && object.body->joint->to.empty()) {
      sinks = std::min(sinks, sinks_on(*object.body->joint, object, center, up));
    }
    energy += object.body->mass * g * sinks;
  }
  return energy;
}

std::vector<std::pair<std::size_t, std::size_t>> overlapping(const Scene& scene) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  BodyGeometry geometry(scene);
  int bodies = 0;
  for (const Object& object : scene.objects) {
    if (object.body) geometry.place(bodies++, object.pose);
  }
  geometry.search(std::vector<std::uint8_t>(static_cast<std::size_t>(bodies), 1), {});
  for (const BodyContact* contact : geometry.points()) {
    if (contact->depth <= kInEachOther) continue;
    const auto [i, j] = std::minmax(contact->object_a, contact->object_b);
    found.emplace_back(i, j);
  }
  std::ranges::sort(found);
  const auto twice = std::unique(found.begin(), found.end());
  found.erase(twice, found.end());
  return found;
}

BodyReport report_on_bodies(const Scene& scene, const ArmDescription& arm) {
  BodyReport report;
  const int bodies = count_bodies(scene);
  if (bodies == 0) return report;
  const double energy = most_weight_energy(scene, arm);
  const double springs = spring_energy(scene);
  report.facts.push_back(
      fmt::format("moves        {} objects, {} springs; the objects' weight may give {:.3g} J, the "
                  "springs {:.3g} J",
                  bodies, scene.springs.size(), energy, springs));
  for (const Object& object : scene.objects) {
    if (!object.body) continue;
    report.facts.push_back(line_of(object));
    warn(object, scene, arm, report);
  }
  if (energy > kHurts) {
    report.warnings.push_back(
        fmt::format("falling objects may give {:.3g} J, more than {} J: falling objects may hurt "
                    "the hand; make the objects lighter, or let the objects start lower",
                    energy, kHurts));
  }
  if (springs > kHurts) {
    report.warnings.push_back(fmt::format(
        "springs that are stretched at the start may give {:.3g} J, more than {} J: "
        "make the springs softer, or let the objects start closer to where the springs are at rest",
        springs, kHurts));
  }
  for (const auto& [i, j] : overlapping(scene)) {
    report.warnings.push_back(fmt::format("'{}' and '{}' overlap at the start",
                                          scene.objects[i].name, scene.objects[j].name));
  }
  return report;
}

}  // namespace limpid
