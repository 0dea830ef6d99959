#include "app/run/scene_flaws.h"

#include <fmt/format.h>

#include <cmath>

#include "app/run/analysis.h"
#include "app/run/body_report.h"
#include "app/run/tip_limits.h"
#include "core/dynamics/arm.h"
#include "core/dynamics/farthest_tip.h"
#include "core/touch/contacts.h"

namespace limpid {
namespace {

constexpr double kInside = 0.0005;  // less than this deep is touching [m]

// Returns how deep the tip is in an object in the arm's rest pose, as its contact springs have it
// when a run begins [m].
double depth_in(const Object& object, const Scene& scene, const ArmDescription& description) {
  Scene alone;
  alone.tip_radius = scene.tip_radius;
  alone.add(object);
  alone.objects.back().body.reset();
  const Arm<kAnyDof> arm(description);
  const Vec<kAnyDof> rest = rest_pose(description);
  Arm<kAnyDof>::Frames frames;
  arm.frames(rest, frames);
  Contacts<kAnyDof> contacts(description, alone);
  contacts.place(arm, frames, rest);
  return std::sqrt(2 * contacts.potential() / object.material.stiffness);
}

void warn_of_friction(const Object& object, std::vector<std::string>& warnings) {
  const Material& m = object.material;
  if (m.friction_kinetic <= m.friction_static) return;
  warnings.push_back(
      fmt::format("'{}': friction_kinetic {:.4g} is above friction_static {:.4g}: friction would "
                  "be larger while the tip slides than while the tip sticks",
                  object.name, m.friction_kinetic, m.friction_static));
}

void warn_of_place(const Object& object, const Scene& scene, const ArmDescription& arm,
                   std::vector<std::string>& warnings) {
  const double reach = farthest_tip(arm).distance;
  const double away = beyond_reach(object, scene, arm);
  if (away > 0) {
    warnings.push_back(fmt::format("'{}' lies {:.3g} m outside the tip's reach of {:.3g} m",
                                   object.name, away, reach));
  }
}

void warn_of_depth(const Object& object, const Scene& scene, const ArmDescription& arm,
                   std::vector<std::string>& warnings) {
  const double depth = depth_in(object, scene, arm);
  if (depth > kInside) {
    warnings.push_back(
        fmt::format("'{}': in the arm's rest pose the tip is {:.3g} mm inside this object",
                    object.name, 1e3 * depth));
  }
}

}  // namespace

std::vector<std::string> scene_flaws(const Scene& scene, const ArmDescription& arm,
                                     const Parameters& p) {
  std::vector<std::string> warnings;
  const TipLimits limits = tip_limits(arm, rest_pose(arm), p, scene);
  const double stiffest = limits.wall(p.kind).stiffness;
  for (const Object& object : scene.objects) {
    if (!has_surface(object)) continue;
    warn_of_friction(object, warnings);
    if (stiffest > 0 && object.material.stiffness > stiffest) {
      warnings.push_back(
          fmt::format("'{}': {:.4g} N/m is stiffer than {:.4g} N/m, the stiffest wall of the {} "
                      "law on this arm "
                      "(`limpid analyze`)",
                      object.name, object.material.stiffness, stiffest, name(p.kind)));
    }
    if (!object.body) warn_of_place(object, scene, arm, warnings);
    warn_of_depth(object, scene, arm, warnings);
  }
  return warnings;
}

}  // namespace limpid
