#include "devices/files/urdf_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/dynamics/arm.h"
#include "devices/files/rpy.h"
#include "devices/files/urdf_path.h"
#include "devices/files/urdf_values.h"

namespace limpid {

namespace {

constexpr double kLeastRange = 1e-3;   // of a joint [rad]; of a slide 0.1 mm
constexpr double kLeastMotion = 1e-6;  // of the tip a radian of a joint [m]
constexpr double kHeaviest = 1e6;      // link [kg]
constexpr int kPoses = 8;              // number of poses in which the tip is checked

void warn_of_joint(const Joint& joint, UrdfPlaces& places) {
  const double unit = slides(joint) ? kSlideUnit : 1;
  if (joint.friction > 0 && joint.friction >= joint.effort) {
    const char* const of_force = slides(joint) ? "N" : "N m";
    places.warn_joint(joint.name,
                      fmt::format("friction {:.3g} {}, effort {:.3g} {}: the motor cannot overcome "
                                  "the joint's friction, so no force of this motor is felt; lower "
                                  "the friction in <dynamics> or raise the effort in <limit>",
                                  joint.friction / unit, of_force, joint.effort / unit, of_force));
  }
  if (joint.upper - joint.lower < kLeastRange) {
    places.warn_joint(
        joint.name,
        fmt::format("limits from {:.6g} to {:.6g} {}: the joint can hardly move; widen the joint's "
                    "<limit>, or make the joint a fixed joint",
                    unit * joint.lower, unit * joint.upper, slides(joint) ? "m" : "rad"));
  }
}

// Returns whether a joint moves the tip, at the rest pose or at others: in one pose it may stand
// still by chance.
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

// The frame moved by the last joint that is farthest from its axis; null if all are on the axis.
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

// Returns whether `axis` has a length that can be made 1.
bool is_direction(const Vec3& axis) {
  return axis.allFinite() && axis.stableNorm() > 1e-9 &&
         std::abs(axis.stableNormalized().norm() - 1) < 1e-9;
}

bool has_no_inertia(const Joint& joint, const Link& link) {
  if (slides(joint)) return !(link.mass > 0);
  return about_origin(link).isZero(0);
}

// Fixes the last joint, and merges its link into the one before.
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

Vec3 vector(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Pose pose(const urdf::Pose& p) {
  Pose out = Pose::Identity();
  out.translation() = vector(p.position);
  const auto& q = p.rotation;
  out.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  return out;
}

const char* kind_of(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::PRISMATIC: return "prismatic";
    case urdf::Joint::FLOATING: return "floating";
    case urdf::Joint::PLANAR: return "planar";
    default: return "of unknown kind";
  }
}

double limit_of(const urdf::Joint& joint, double urdf::JointLimits::*field, double otherwise) {
  return joint.limits ? (*joint.limits).*field : otherwise;
}

class Chain {
 public:
  Chain(const urdf::ModelInterface& model, const std::vector<urdf::JointConstSharedPtr>& way,
        const LinkShapes& visuals, UrdfPlaces& places)
      : model_(model), way_(way), visuals_(visuals), places_(places) {}

  ArmDescription build() {
    arm_.name = model_.getName();
    for (std::size_t i = 0; i < way_.size(); ++i) {
      if (moves(*way_[i])) last_moving_ = i;
    }
    urdf::LinkConstSharedPtr link = model_.getRoot();
    Pose here = Pose::Identity();
    for (std::size_t i = 0; i <= way_.size(); ++i) {
      const urdf::Joint* on = i < way_.size() ? way_[i].get() : nullptr;
      add_tree(*link, here, on);
      if (on == nullptr) break;
      here = pass(*on, here, i);
      link = model_.getLink(on->child_link_name);
    }
    if (arm_.joints.empty()) refuse_still();
    arm_.tip = here;
    arm_.tip_link = way_.back()->child_link_name;
    say_held();
    shorten_to_mass(arm_, places_);
    complete_inertias(arm_, places_);
    complete_efforts(arm_, places_);
    warn_of_immobile(arm_, places_);
    return std::move(arm_);
  }

 private:
  int moving() const { return arm_.dof() - 1; }

  // Refuses a way without moving joints; those that move may all be in grippers, which are no tips.
  [[noreturn]] void refuse_still() const {
    for (const auto& [name, joint] : model_.joints_) {
      if (!moves(*joint)) continue;
      places_.refuse(
          fmt::format("no joint moves the link '{}', but other links move; use --tip LINK to "
                      "choose the link that the hand holds, for example '{}'",
                      way_.empty() ? model_.getRoot()->name : way_.back()->child_link_name,
                      joint->child_link_name));
    }
    places_.refuse(
        fmt::format("no joint moves; needed: 1 to {} joints that are revolute, continuous or "
                    "prismatic, with limits that allow motion (lower below upper)",
                    kMaxDof));
  }

  // Adds a link and all that it carries, without what is behind joint `on`.
  void add_tree(const urdf::Link& link, const Pose& here, const urdf::Joint* on) {
    arm_.frames.push_back({link.name, moving(), here});
    if (link.inertial) add_inertial(link, here);
    const auto visuals = visuals_.find(link.name);
    if (visuals != visuals_.end()) {
      for (Visual visual : visuals->second) {
        visual.link = moving();
        visual.origin = here * visual.origin;
        arm_.visuals.push_back(visual);
      }
    }
    for (const auto& joint : link.child_joints) {
      if (joint.get() == on) continue;
      add_tree(*model_.getLink(joint->child_link_name), held(*joint, here), nullptr);
    }
  }

  void add_inertial(const urdf::Link& link, const Pose& here) {
    const urdf::Inertial& body = *link.inertial;
    for (const double x : {body.ixx, body.ixy, body.ixz, body.iyy, body.iyz, body.izz}) {
      if (!std::isfinite(x)) places_.refuse_link(link.name, "inertial: a number is not finite");
    }
    if (const std::string why = refused_origin(vector(body.origin.position)); !why.empty()) {
      places_.refuse_link(link.name, "inertial: " + why);
    }
    if (!(body.mass >= 0 && body.mass <= kHeaviest)) {
      places_.refuse_link(link.name,
                          fmt::format("mass {} kg; allowed: 0 to {} kg", body.mass, kHeaviest));
    }
    if (moving() < 0) return;
    Link own;
    own.mass = body.mass;
    own.inertia << body.ixx, body.ixy, body.ixz,  //
        body.ixy, body.iyy, body.iyz,             //
        body.ixz, body.iyz, body.izz;
    merge(arm_.links.back(), own, here * pose(body.origin));
  }

  Pose origin_of(const urdf::Joint& joint, const Pose& here) const {
    const urdf::Pose& given = joint.parent_to_joint_origin_transform;
    if (const std::string why = refused_origin(vector(given.position)); !why.empty()) {
      places_.refuse_joint(joint.name, why);
    }
    const Pose origin = here * pose(given);
    if (!origin.matrix().allFinite()) {
      places_.refuse_joint(joint.name, "origin: a number is not finite");
    }
    return origin;
  }

  // Pose of the child of a joint that is held still.
  Pose held(const urdf::Joint& joint, const Pose& here) {
    Pose there = origin_of(joint, here);
    if (joint.type == urdf::Joint::FIXED) return there;
    held_.push_back(joint.name);
    const Vec3 axis = vector(joint.axis);
    const double at = held_at(joint);
    if (!is_direction(axis) || at == 0) return there;
    if (joint.type == urdf::Joint::PRISMATIC) {
      there.translate(Vec3(at * axis.stableNormalized()));
    } else {
      there.rotate(turn(at, axis.stableNormalized()));
    }
    return there;
  }

  // Passes joint i of the way. Returns the frame of its child in the frame of the moving link.
  Pose pass(const urdf::Joint& joint, const Pose& here, std::size_t i) {
    if (joint.mimic && i < last_moving_) {
      places_.refuse_joint(joint.name,
                           "mimics another joint inside the chain; this is not supported: choose a "
                           "tip before this joint (--tip LINK)");
    }
    if (!moves(joint)) return held(joint, here);
    const Pose origin = origin_of(joint, here);
    if (joint.type != urdf::Joint::REVOLUTE && joint.type != urdf::Joint::CONTINUOUS &&
        joint.type != urdf::Joint::PRISMATIC) {
      places_.refuse_joint(
          joint.name,
          fmt::format("{}; allowed: revolute, continuous, prismatic, fixed", kind_of(joint)));
    }
    if (arm_.dof() == kMaxDof) {
      places_.refuse_joint(joint.name,
                           fmt::format("too many joints; at most {} joints may move", kMaxDof));
    }
    arm_.joints.push_back(moving_joint(joint, origin));
    Link link;
    link.name = joint.child_link_name;
    arm_.links.push_back(link);
    return Pose::Identity();
  }

  Joint moving_joint(const urdf::Joint& joint, const Pose& origin) const {
    Joint out;
    out.name = joint.name;
    out.origin = origin;
    const Vec3 axis = vector(joint.axis);
    if (!is_direction(axis)) {
      places_.refuse_joint(joint.name, "axis is zero or not finite; needed: a direction");
    }
    out.axis = axis.stableNormalized();
    const bool slides = joint.type == urdf::Joint::PRISMATIC;
    if (slides || joint.type == urdf::Joint::REVOLUTE) {
      out.lower = limit_of(joint, &urdf::JointLimits::lower, 0);
      out.upper = limit_of(joint, &urdf::JointLimits::upper, 0);
      if (!(out.lower < out.upper) || !std::isfinite(out.upper - out.lower)) {
        places_.refuse_joint(joint.name,
                             fmt::format("limits from {} to {} {}; needed: finite, lower below "
                                         "upper",
                                         out.lower, out.upper, slides ? "m" : "rad"));
      }
    }
    out.effort =
        at_least_zero(joint.name, "effort", limit_of(joint, &urdf::JointLimits::effort, 0));
    if (joint.dynamics) {
      out.damping = at_least_zero(joint.name, "damping", joint.dynamics->damping);
      out.friction = at_least_zero(joint.name, "friction", joint.dynamics->friction);
    }
    if (slides) in_units_of_travel(out);
    return out;
  }

  // Converts a slide from m, N and N s/m to units of its travel.
  static void in_units_of_travel(Joint& joint) {
    joint.kind = Joint::Kind::prismatic;
    joint.lower /= kSlideUnit;
    joint.upper /= kSlideUnit;
    joint.effort *= kSlideUnit;
    joint.friction *= kSlideUnit;
    joint.damping *= kSlideUnit * kSlideUnit;
  }

  double at_least_zero(const std::string& joint, const char* what, double x) const {
    if (x >= 0 && std::isfinite(x)) return x;
    places_.refuse_joint(joint, fmt::format("{} {}; needed: 0 or more", what, x));
  }

  void say_held() {
    if (held_.empty()) return;
    constexpr std::size_t kNamed = 6;
    const std::size_t named = std::min(held_.size(), kNamed);
    places_.warn(fmt::format(
        "joints that are held still, because they are not in the chain to '{}': {}{}",
        arm_.tip_link,
        fmt::join(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(named), ", "),
        held_.size() > named ? fmt::format(" and {} more joints", held_.size() - named) : ""));
  }

  const urdf::ModelInterface& model_;
  const std::vector<urdf::JointConstSharedPtr>& way_;
  const LinkShapes& visuals_;
  UrdfPlaces& places_;
  ArmDescription arm_;
  std::size_t last_moving_ = 0;
  std::vector<std::string> held_;
};

}  // namespace

void warn_of_immobile(const ArmDescription& arm, UrdfPlaces& places) {
  for (const Joint& joint : arm.joints) warn_of_joint(joint, places);
  if (tip_moves(arm)) return;
  const NamedFrame* const other = beside_axis(arm);
  places.warn_link(
      arm.tip_link,
      fmt::format("the tip lies on the axis of '{}', so no joint moves the tip: a hand at the tip "
                  "cannot move the arm; use --tip LINK to choose a link that is not on the axis{}",
                  arm.joints.back().name,
                  other != nullptr ? fmt::format(" (for example '{}')", other->name)
                                   : ", or add such a link to the file with a fixed joint"));
}

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

ArmDescription chain_of(const urdf::ModelInterface& model,
                        const std::vector<urdf::JointConstSharedPtr>& way,
                        const LinkShapes& visuals, UrdfPlaces& places) {
  return Chain(model, way, visuals, places).build();
}

}  // namespace limpid
