#include "devices/files/arm/immobile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/dynamics/arm.h"
#include "devices/files/arm/body.h"

namespace limpid {
namespace {

constexpr double kLeastRange = 1e-3;   // of a joint [rad], of a slide 0.1 mm
constexpr double kLeastMotion = 1e-6;  // of the tip, for 1 rad of a joint [m]
constexpr int kPoses = 8;              // in which the tip is looked at

void warn_of_joint(const Joint& joint, UrdfPlaces& places) {
  const double unit = slides(joint) ? kSlideUnit : 1;
  if (joint.friction > 0 && joint.friction >= joint.effort) {
    const char* const of_force = slides(joint) ? "N" : "N m";
    places.warn_joint(joint.name,
                      fmt::format("friction {:.3g} {}, effort {:.3g} {}: its motor cannot overcome "
                                  "its friction, and no force of it is felt; lower the friction in "
                                  "<dynamics> or raise the effort in <limit>",
                                  joint.friction / unit, of_force, joint.effort / unit, of_force));
  }
  if (joint.upper - joint.lower < kLeastRange) {
    places.warn_joint(
        joint.name,
        fmt::format("limits from {:.6g} to {:.6g} {}: it has hardly any room to move; "
                    "widen its <limit>, or make it a fixed joint",
                    unit * joint.lower, unit * joint.upper, slides(joint) ? "m" : "rad"));
  }
}

// At the rest pose, and at others: by chance a tip may stand still in one.
bool tip_moves(const ArmDescription& description) {
  const Arm<kAnyDof> arm(description);
  std::mt19937 random(1);
  Vec<kAnyDof> x = rest_pose(description);
  for (int pose = 0; pose < kPoses; ++pose) {
    Arm<kAnyDof>::Frames f;
    arm.frames(x, f);
    Jacobian<kAnyDof> J;
    arm.point_jacobian(f, arm.dof() - 1, arm.tip(f), J);
    if (J.colwise().norm().maxCoeff() > kLeastMotion) return true;
    for (int i = 0; i < arm.dof(); ++i) {
      const Joint& joint = description.joints[static_cast<std::size_t>(i)];
      const double to = static_cast<double>(random()) / 4294967295.0;
      x[i] = std::clamp(6 * to - 3, joint.lower, joint.upper);
    }
  }
  return false;
}

// Of the frames that the last joint moves the one farthest from its axis; null where all are on it.
const NamedFrame* beside_axis(const ArmDescription& arm) {
  const Vec3& axis = arm.joints.back().axis;
  const NamedFrame* best = nullptr;
  double most = kLeastMotion;
  for (const NamedFrame& frame : arm.frames) {
    if (frame.link != arm.dof() - 1) continue;
    const double far = axis.cross(frame.origin.translation()).norm();
    if (far > most) {
      most = far;
      best = &frame;
    }
  }
  return best;
}

}  // namespace

void warn_of_immobile(const ArmDescription& arm, UrdfPlaces& places) {
  for (const Joint& joint : arm.joints) warn_of_joint(joint, places);
  if (tip_moves(arm)) return;
  const NamedFrame* const other = beside_axis(arm);
  places.warn_link(
      arm.tip_link,
      fmt::format("the tip lies on the axis of '{}', and no joint moves it: a hand at the tip "
                  "cannot move the arm; name a link beside the axis with --tip LINK{}",
                  arm.joints.back().name,
                  other != nullptr ? fmt::format(" ('{}' is one)", other->name)
                                   : ", or fix one there in the file"));
}

}  // namespace limpid
