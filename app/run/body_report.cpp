#include "app/run/body_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/dynamics/farthest_tip.h"
#include "core/math/elementary.h"
#include "core/touch/contacts.h"
#include "core/touch/mass_properties.h"
#include "core/touch/triangle_mesh.h"

namespace limpid {
namespace {

constexpr double kInEachOther = 0.0005;  // less than this deep is touching [m]
constexpr double kHurts = 0.2;           // [J]

// The box around a mesh, in its object's frame: as a box at a pose.
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

// A part of a surface: a segment with a ball that goes along it.
struct Edge {
  Vec3 from, to;  // in the world [m]
  double radius = 0;
};

void add_edges(const Box& box, const Pose& pose, std::vector<Edge>& out) {
  const auto corner = [&](int i) {
    const Vec3 sign(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    return Vec3(pose * sign.cwiseProduct(box.size));
  };
  for (int i = 0; i < 8; ++i) {
    for (const int bit : {1, 2, 4}) {
      if ((i & bit) == 0) out.push_back({corner(i), corner(i | bit)});
    }
  }
  out.push_back({corner(0), corner(7)});
}

void add_edges(const Cylinder& cylinder, const Pose& pose, std::vector<Edge>& out) {
  constexpr int kSides = 16;
  const auto rim = [&](int i, double end) {
    const auto [s, c] = sine_cosine(2 * std::numbers::pi * i / kSides);
    return Vec3(pose * Vec3(cylinder.radius * c, cylinder.radius * s, end * cylinder.length));
  };
  for (int i = 0; i < kSides; ++i) {
    out.push_back({rim(i, -0.5), rim(i, 0.5)});
    for (const double end : {-0.5, 0.5}) {
      out.push_back({rim(i, end), rim(i + 1, end)});
      if (i < kSides / 2) out.push_back({rim(i, end), rim(i + kSides / 2, end)});
    }
  }
}

void add_edges(const Capsule& capsule, const Pose& pose, std::vector<Edge>& out) {
  const Vec3 end = capsule.length / 2 * Vec3::UnitZ();
  out.push_back({pose * Vec3(-end), pose * end, capsule.radius});
}

void add_edges(const Sphere& sphere, const Pose& pose, std::vector<Edge>& out) {
  out.push_back({pose.translation(), pose.translation(), sphere.radius});
}

double less(double length, double by) { return std::max(length - by, 0.0); }

// Of a shape that is smaller on all sides, so that what only touches is in nothing.
void add_edges(const Shape& shape, const Pose& pose, std::vector<Edge>& out) {
  constexpr double by = kInEachOther;
  if (const auto* box = std::get_if<Box>(&shape)) {
    add_edges(Box{(box->size.array() - 2 * by).max(0)}, pose, out);
  } else if (const auto* ball = std::get_if<Sphere>(&shape)) {
    add_edges(Sphere{less(ball->radius, by)}, pose, out);
  } else if (const auto* c = std::get_if<Cylinder>(&shape)) {
    add_edges(Cylinder{less(c->radius, by), less(c->length, 2 * by)}, pose, out);
  } else if (const auto* k = std::get_if<Capsule>(&shape)) {
    add_edges(Capsule{less(k->radius, by), k->length}, pose, out);
  } else if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    const auto [around, at] = box_around(*mesh);
    add_edges(Shape(around), pose * at, out);
  }
}

template <class S>
bool enters(const Edge& edge, const S& shape, const Pose& pose) {
  const Vec3 near =
      edge.from == edge.to ? edge.from : nearest_on_segment(shape, pose, edge.from, edge.to);
  return distance_to(shape, pose, near).distance < edge.radius;
}

bool enters(const Edge&, const JointStop&, const Pose&) { return false; }

// Through the surface of a mesh, or nearer to it than its ball is large.
bool enters(const Edge& edge, const Mesh& mesh, const Pose& pose) {
  if (!mesh.triangles || !(mesh.size() > 0)) return false;
  const Pose back = mesh.stood(pose).inverse();
  const auto local = [&](const Vec3& p) {
    return Vec3(back * p / mesh.size() - mesh.triangles->middle());
  };
  const Vec3 from = local(edge.from), to = local(edge.to);
  MeshPoint found;
  if (from != to && mesh.triangles->crossing(from, to, found)) return true;
  const double within = edge.radius / mesh.size();
  return within > 0 && (mesh.triangles->nearest(from, within, MeshPoint::kNone, found) ||
                        mesh.triangles->nearest(to, within, MeshPoint::kNone, found));
}

struct Placed {
  Shape shape;
  Pose pose;
};

// Shape and parts in the world; of a body's mesh the box around it.
std::vector<Placed> pieces(const Object& object) {
  std::vector<Placed> all{{object.shape, object.pose}};
  if (const auto* mesh = std::get_if<Mesh>(&object.shape); mesh != nullptr && object.body) {
    const auto [box, at] = box_around(*mesh);
    all[0] = {box, object.pose * at};
  }
  for (const BodyPart& part : object.parts) all.push_back({part.shape, object.pose * part.pose});
  return all;
}

bool edges_enter(const Object& a, const Object& b) {
  std::vector<Edge> edges;
  for (const Placed& piece : pieces(a)) add_edges(piece.shape, piece.pose, edges);
  for (const Placed& piece : pieces(b)) {
    for (const Edge& edge : edges) {
      if (std::visit([&](const auto& s) { return enters(edge, s, piece.pose); }, piece.shape)) {
        return true;
      }
    }
  }
  return false;
}

bool hangs_on(const Object& a, const Object& b) {
  return a.body && a.body->joint && b.body && a.body->joint->to == b.name;
}

double half_width(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return box->size.minCoeff() / 2;
  if (const auto* ball = std::get_if<Sphere>(&shape)) return ball->radius;
  if (const auto* c = std::get_if<Cylinder>(&shape)) return std::min(c->radius, c->length / 2);
  if (const auto* k = std::get_if<Capsule>(&shape)) return k->radius;
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    return box_around(*mesh).first.size.minCoeff() / 2;
  }
  return 0;
}

Vec3 root_of(const ArmDescription& arm) {
  return arm.joints.empty() ? Vec3(Vec3::Zero()) : Vec3(arm.joints.front().origin.translation());
}

// How high above the origin what falls comes to rest.
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

// How far a joint on the world lets a centre of mass sink; what else it hangs on may sink, too.
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
  if (!object.parts.empty()) text += fmt::format(", {} parts more", object.parts.size());
  if (body.joint) {
    constexpr std::array kKinds{"slides", "turns", "hangs"};
    text += fmt::format(", {} on {}", kKinds[static_cast<std::size_t>(body.joint->kind)],
                        body.joint->to.empty() ? "the world" : "'" + body.joint->to + "'");
  }
  if (body.magnet) text += ", can be picked up";
  return text;
}

// How far the tip stays away from it at the least [m].
double out_of_reach(const Object& object, const Scene& scene, const Vec3& root, double reach) {
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
  return least - reach - scene.tip_radius;
}

void warn(const Object& object, const Scene& scene, const Vec3& root, double reach,
          BodyReport& report) {
  const double away = out_of_reach(object, scene, root, reach);
  if (away > 0) {
    report.warnings.push_back(
        fmt::format("'{}': {:.3g} m beyond the tip's reach of {:.3g} m", object.name, away, reach));
  }
  if (object.body->inertia && !possible_inertia(*object.body->inertia)) {
    const Vec3& i = *object.body->inertia;
    report.warnings.push_back(fmt::format(
        "'{}': no body has an inertia of [{:.4g}, {:.4g}, {:.4g}] kg m^2: none of the three may "
        "be more than the other two together",
        object.name, i.x(), i.y(), i.z()));
  }
}

}  // namespace

bool possible_inertia(const Vec3& inertia) {
  return 2 * inertia.maxCoeff() <= (1 + 1e-9) * inertia.sum();
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
    double sinks = std::max(0.0, up.dot(center) - floor - half_width(object.shape));
    if (object.body->joint && object.body->joint->to.empty()) {
      sinks = std::min(sinks, sinks_on(*object.body->joint, object, center, up));
    }
    energy += object.body->mass * g * sinks;
  }
  return energy;
}

std::vector<std::pair<std::size_t, std::size_t>> overlapping(const Scene& scene) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  const std::vector<Object>& objects = scene.objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (std::size_t j = i + 1; j < objects.size(); ++j) {
      const Object &a = objects[i], &b = objects[j];
      if ((!a.body && !b.body) || hangs_on(a, b) || hangs_on(b, a)) continue;
      if (edges_enter(a, b) || edges_enter(b, a)) found.emplace_back(i, j);
    }
  }
  return found;
}

BodyReport report_on_bodies(const Scene& scene, const ArmDescription& arm) {
  BodyReport report;
  const int bodies = count_bodies(scene);
  if (bodies == 0) return report;
  const double energy = most_weight_energy(scene, arm);
  report.facts.push_back(
      fmt::format("moves        {} of them, {} springs; their weight may give {:.3g} J", bodies,
                  scene.springs.size(), energy));
  const Vec3 root = root_of(arm);
  const double reach = farthest_tip(arm).distance;
  for (const Object& object : scene.objects) {
    if (!object.body) continue;
    report.facts.push_back(line_of(object));
    warn(object, scene, root, reach, report);
  }
  if (energy > kHurts) {
    report.warnings.push_back(fmt::format(
        "falling, its bodies may give {:.3g} J, more than {} J: a falling kilogram hurts; make "
        "them lighter, or let them start lower",
        energy, kHurts));
  }
  for (const auto& [i, j] : overlapping(scene)) {
    report.warnings.push_back(fmt::format("'{}' and '{}' are in each other at the start",
                                          scene.objects[i].name, scene.objects[j].name));
  }
  return report;
}

}  // namespace limpid
