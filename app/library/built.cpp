#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/library/limpid/limpid.h"
#include "app/run/urdf_writer.h"
#include "devices/files/rpy.h"

namespace limpid {
namespace {

Vec3 vec3(const Point3& p) { return {p[0], p[1], p[2]}; }

// A name in quotes, as TOML has it.
std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\') text += '\\';
    text += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return text + '"';
}

std::string surface_text(const SurfaceMaterial& of) {
  return fmt::format(
      "stiffness = {:.17g}\ndamping = {:.17g}\nfriction_static = {:.17g}\n"
      "friction_kinetic = {:.17g}\n",
      of.stiffness, of.damping, std::max(of.sticking, of.friction), of.friction);
}

std::string point_text(const Point3& p) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", p[0], p[1], p[2]);
}

void refuse_not_finite(const std::string& what, std::span<const double> numbers) {
  for (const double each : numbers) {
    if (std::isfinite(each)) continue;
    throw LoopError(
        fmt::format("arm: {}: {} is not allowed; allowed: a finite number", what, each));
  }
}

void refuse_not_finite(const ArmJoint& of) {
  const auto refuse = [&](const char* what, std::span<const double> numbers) {
    refuse_not_finite(fmt::format("joint '{}': {}", of.name, what), numbers);
  };
  refuse("position", of.position);
  refuse("rpy", of.rpy);
  refuse("axis", of.axis);
  refuse("lower", {&of.lower, 1});
  refuse("upper", {&of.upper, 1});
  if (!std::isnan(of.effort)) refuse("effort", {&of.effort, 1});
  refuse("damping", {&of.damping, 1});
  refuse("friction", {&of.friction, 1});
  refuse("mass", {&of.mass, 1});
  refuse("center", of.center);
  refuse("inertia", of.inertia);
}

}  // namespace

std::string urdf_text(const ArmModel& arm) {
  ArmDescription out;
  out.name = arm.name;
  refuse_not_finite("tip", arm.tip);
  for (const ArmJoint& of : arm.joints) {
    refuse_not_finite(of);
    if (of.effort <= 0) {
      throw LoopError(
          fmt::format("arm: joint '{}': effort {} is not allowed; allowed: above 0; kGuessed lets "
                      "Limpid choose",
                      of.name, of.effort));
    }
    const double unit = of.slides ? kSlideUnit : 1;
    Joint joint;
    joint.name = of.name;
    joint.kind = of.slides ? Joint::Kind::prismatic : Joint::Kind::revolute;
    joint.origin.translation() = vec3(of.position);
    joint.origin.linear() = rotation(vec3(of.rpy));
    joint.axis = vec3(of.axis);
    joint.lower = of.lower / unit;
    joint.upper = of.upper / unit;
    joint.effort = std::isnan(of.effort) ? 0 : of.effort * unit;  // URDF's 0 is guessed
    joint.damping = of.damping * unit * unit;
    joint.friction = of.friction * unit;
    Link link;
    link.name = of.name + "_link";
    link.mass = of.mass;
    link.com = vec3(of.center);
    const auto& [xx, xy, xz, yy, yz, zz] = of.inertia;
    link.inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    out.joints.push_back(std::move(joint));
    out.links.push_back(std::move(link));
  }
  out.tip.translation() = vec3(arm.tip);
  out.tip_link = "tip";
  return urdf_text(out, "Built by a program.");
}

SceneBuilder& SceneBuilder::plane(const std::string& name, Point3 point, Point3 normal,
                                  SurfaceMaterial of) {
  text_ += fmt::format("\n[[plane]]\nname = {}\npoint = {}\nnormal = {}\n{}", quoted(name),
                       point_text(point), point_text(normal), surface_text(of));
  return *this;
}

SceneBuilder& SceneBuilder::sphere(const std::string& name, Point3 center, double radius,
                                   SurfaceMaterial of) {
  text_ += fmt::format("\n[[sphere]]\nname = {}\ncenter = {}\nradius = {:.17g}\n{}", quoted(name),
                       point_text(center), radius, surface_text(of));
  return *this;
}

SceneBuilder& SceneBuilder::box(const std::string& name, Point3 center, Point3 size,
                                SurfaceMaterial of) {
  text_ += fmt::format("\n[[box]]\nname = {}\ncenter = {}\nsize = {}\n{}", quoted(name),
                       point_text(center), point_text(size), surface_text(of));
  return *this;
}

SceneBuilder& SceneBuilder::ball(const std::string& name, Point3 center, double radius, double mass,
                                 SurfaceMaterial of) {
  text_ += fmt::format("\n[[body]]\nname = {}\nsphere = {:.17g}\nmass = {:.17g}\nposition = {}\n{}",
                       quoted(name), radius, mass, point_text(center), surface_text(of));
  return *this;
}

SceneBuilder& SceneBuilder::block(const std::string& name, Point3 center, Point3 size, double mass,
                                  SurfaceMaterial of) {
  text_ += fmt::format("\n[[body]]\nname = {}\nbox = {}\nmass = {:.17g}\nposition = {}\n{}",
                       quoted(name), point_text(size), mass, point_text(center), surface_text(of));
  return *this;
}

SceneBuilder& SceneBuilder::toml(const std::string& text) {
  text_ += '\n' + text + '\n';
  return *this;
}

}  // namespace limpid
