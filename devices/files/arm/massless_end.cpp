#include "devices/files/arm/massless_end.h"

#include <fmt/format.h>

#include <algorithm>

#include "devices/files/arm/body.h"
#include "devices/files/rpy.h"

namespace limpid {
namespace {

bool has_no_inertia(const Joint& joint, const Link& link) {
  if (slides(joint)) return !(link.mass > 0);
  return about_origin(link).isZero(0);
}

// The last joint stays where it is, and its link becomes a part of the one before.
void fix_last(ArmDescription& arm) {
  const Joint& joint = arm.joints.back();
  const double at = std::clamp(0.0, joint.lower, joint.upper);
  Pose there = joint.origin;
  if (slides(joint)) {
    there.translate(Vec3(kSlideUnit * at * joint.axis));
  } else {
    there.rotate(turn(at, joint.axis));
  }
  const int last = arm.dof() - 1;
  const auto carry = [&](auto& parts) {
    for (auto& part : parts) {
      if (part.link != last) continue;
      part.link = last - 1;
      part.origin = there * part.origin;
    }
  };
  carry(arm.frames);
  carry(arm.visuals);
  arm.tip = there * arm.tip;
  merge(arm.links[arm.links.size() - 2], arm.links.back(), there);
  arm.links.pop_back();
  arm.joints.pop_back();
}

}  // namespace

void shorten_to_mass(ArmDescription& arm, UrdfPlaces& places) {
  std::vector<std::string> links, joints;
  while (arm.dof() > 1 && has_no_inertia(arm.joints.back(), arm.links.back())) {
    links.push_back("'" + arm.links.back().name + "'");
    joints.push_back("'" + arm.joints.back().name + "'");
    fix_last(arm);
  }
  if (links.empty()) return;
  std::ranges::reverse(links);
  std::ranges::reverse(joints);
  const bool one = links.size() == 1;
  places.warn(fmt::format(
      "{} {} at the end of the chain {} no inertia, and so {} held still; the last joint that "
      "moves "
      "is '{}'. An <inertial> with mass and inertia lets {} move",
      one ? "link" : "links", fmt::join(links, ", "), one ? "has" : "have",
      one ? "joint " + joints[0] + " is" : fmt::format("joints {} are", fmt::join(joints, ", ")),
      arm.joints.back().name, one ? "it" : "them"));
}

}  // namespace limpid
