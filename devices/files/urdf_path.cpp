#include "devices/files/urdf_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/dynamics/arm_description.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

using Way = std::vector<urdf::JointConstSharedPtr>;

constexpr std::size_t kMostChainLinks = 5000;
constexpr int kDeepestChain = 500;

bool is_fixed(const urdf::JointConstSharedPtr& joint) { return joint->type == urdf::Joint::FIXED; }

// Refuses what is no tree of limited depth, on which recursion below relies.
void check_tree(const urdf::ModelInterface& model, const UrdfPlaces& places) {
  if (model.links_.size() > kMostChainLinks) {
    places.refuse(fmt::format("{} links; at most {}", model.links_.size(), kMostChainLinks));
  }
  std::map<std::string, std::string> carrier;
  for (const auto& [name, joint] : model.joints_) {
    const auto [other, first] = carrier.emplace(joint->child_link_name, name);
    if (first) continue;
    places.refuse_link(joint->child_link_name,
                       fmt::format("is the child of two joints, '{}' and '{}'; needed: one joint",
                                   other->second, name));
  }
  for (const auto& [name, link] : model.links_) {
    int depth = 0;
    for (auto at = link; at->getParent() != nullptr; at = at->getParent()) {
      if (++depth > kDeepestChain) {
        places.refuse_link(name, "too many links in the chain before this link");
      }
    }
  }
}

// Summary of a joint and everything behind it.
struct Branch {
  int moving = 0;          // most moving joints on one way outwards
  bool turns = false;      // any moving joint is no slide
  bool any_joint = false;  // any joint is not fixed, mimics included
  double mass = 0;         // moved by its joints [kg]
  std::string tip;         // end of the way with the most moving joints
};

class Search {
 public:
  Search(const urdf::ModelInterface& model, const UrdfPlaces& places)
      : model_(model), places_(places) {}

  Way longest() {
    Way way;
    urdf::LinkConstSharedPtr link = model_.getRoot();
    while (const urdf::JointConstSharedPtr next = choose(*link)) {
      way.push_back(next);
      link = model_.getLink(next->child_link_name);
    }
    const Way end = farthest(*link);
    way.insert(way.end(), end.begin(), end.end());
    return way;
  }

 private:
  [[noreturn]] void ask(const urdf::Link& link, const std::string& one,
                        const std::string& other) const {
    std::vector<ArmTip> tips;
    list_tips(*model_.getRoot(), 0, tips);
    std::ranges::stable_sort(tips, std::ranges::greater{}, &ArmTip::joints);
    std::string all;
    for (const ArmTip& tip : tips) {
      all += fmt::format("{}'{}' ({})", all.empty() ? "" : ", ", tip.link, tip.joints);
    }
    try {
      places_.refuse_link(link.name,
                          fmt::format("the arm branches here, to '{}' and '{}'; use --tip LINK to "
                                      "choose the tip. The other branches are then held still. "
                                      "Possible tips, with the number of joints to each tip: {}",
                                      one, other, all));
    } catch (const FileError& error) {
      throw TipsToChoose(error, places_.where, std::move(tips));
    }
  }

  // Lists ends, and links where the way branches: a palm is a tip as well as its fingers are.
  void list_tips(const urdf::Link& link, int joints, std::vector<ArmTip>& tips) const {
    int further = 0;
    for (const auto& joint : link.child_joints) {
      if (branch(*joint).moving == 0) continue;
      ++further;
      list_tips(*model_.getLink(joint->child_link_name), joints + (moves(*joint) ? 1 : 0), tips);
    }
    if (joints == 0 || further == 1) return;
    const Way end = further == 0 ? farthest(link) : Way{};
    tips.push_back({end.empty() ? link.name : end.back()->child_link_name, joints});
  }

  Branch branch(const urdf::Joint& joint) const {
    const urdf::LinkConstSharedPtr link = model_.getLink(joint.child_link_name);
    Branch all;
    all.tip = link->name;
    const bool own = moves(joint);
    const bool any = joint.type != urdf::Joint::FIXED;
    all.turns = own && joint.type != urdf::Joint::PRISMATIC;
    all.any_joint = any;
    if (any && link->inertial) all.mass = link->inertial->mass;
    for (const auto& child : link->child_joints) {
      const Branch outer = branch(*child);
      if (outer.moving > all.moving) {
        all.moving = outer.moving;
        all.tip = outer.tip;
      }
      all.turns = all.turns || outer.turns;
      all.any_joint = all.any_joint || outer.any_joint;
      all.mass += any ? whole_mass(*child) : outer.mass;
    }
    if (own) ++all.moving;
    return all;
  }

  double whole_mass(const urdf::Joint& joint) const {
    const urdf::LinkConstSharedPtr link = model_.getLink(joint.child_link_name);
    double mass = link->inertial ? link->inertial->mass : 0;
    for (const auto& child : link->child_joints) mass += whole_mass(*child);
    return mass;
  }

  // The joint by which the arm goes on; null where it ends.
  urdf::JointConstSharedPtr choose(const urdf::Link& link) const {
    urdf::JointConstSharedPtr turning, sliding;
    Branch by;
    int with_joints = 0, turns = 0;
    for (const auto& joint : link.child_joints) {
      const Branch b = branch(*joint);
      if (b.any_joint) ++with_joints;
      if (b.moving == 0) continue;
      if (!b.turns) {
        sliding = joint;
        continue;
      }
      ++turns;
      if (turning && by.mass > 0 && b.mass > 0) {
        ask(link, by.tip, b.tip);
      }
      if (turning && std::pair(by.mass > 0, by.moving) >= std::pair(b.mass > 0, b.moving)) continue;
      turning = joint;
      by = b;
    }
    const bool weightless = turning && turns > 1 && !(by.mass > 0);  // fingers without inertia
    if (turning) return weightless ? nullptr : turning;
    return with_joints == 1 ? sliding : nullptr;
  }

  // The way over fixed joints alone to the farthest link that is an end or carries a joint.
  Way farthest(const urdf::Link& link) const {
    Way best;
    double most = -1;
    Way way;
    look(link, Pose::Identity(), way, most, best);
    return best;
  }
  void look(const urdf::Link& link, const Pose& here, Way& way, double& most, Way& best) const {
    const bool ends = std::ranges::none_of(link.child_joints, is_fixed);
    const bool carries = !std::ranges::all_of(link.child_joints, is_fixed);
    if (const double far = here.translation().norm(); (ends || carries) && far > most) {
      most = far;
      best = way;
    }
    for (const auto& joint : link.child_joints) {
      if (!is_fixed(joint)) continue;
      const auto& o = joint->parent_to_joint_origin_transform;
      Pose there = Pose::Identity();
      there.translation() = Vec3(o.position.x, o.position.y, o.position.z);
      there.linear() = Eigen::Quaterniond(o.rotation.w, o.rotation.x, o.rotation.y, o.rotation.z)
                           .normalized()
                           .toRotationMatrix();
      way.push_back(joint);
      look(*model_.getLink(joint->child_link_name), here * there, way, most, best);
      way.pop_back();
    }
  }

  const urdf::ModelInterface& model_;
  const UrdfPlaces& places_;
};

Way named(const urdf::ModelInterface& model, const std::string& tip, const UrdfPlaces& places) {
  urdf::LinkConstSharedPtr link = model.getLink(tip);
  if (!link) {
    std::string some;
    for (const auto& [name, each] : model.links_) {
      if (each->child_joints.empty() && some.size() < 200)
        some += (some.empty() ? "" : ", ") + name;
    }
    places.refuse(
        fmt::format("tip '{}': there is no such link; links at the end of a chain: {}", tip, some));
  }
  Way way;
  for (; link->parent_joint; link = model.getLink(link->parent_joint->parent_link_name)) {
    way.push_back(link->parent_joint);
  }
  std::ranges::reverse(way);
  if (std::ranges::none_of(way, [](const auto& joint) { return moves(*joint); })) {
    places.refuse_link(tip, "no joint moves this link, so the link cannot be the tip");
  }
  return way;
}

}  // namespace

double held_at(const urdf::Joint& joint) {
  if (!joint.limits || joint.type == urdf::Joint::CONTINUOUS) return 0;
  const double at = std::max(joint.limits->lower, std::min(joint.limits->upper, 0.0));
  return std::isfinite(at) ? at : 0;
}

bool moves(const urdf::Joint& joint) {
  if (joint.mimic || joint.type == urdf::Joint::FIXED) return false;
  const bool bounded = joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::PRISMATIC;
  return !(bounded && joint.limits && joint.limits->lower == joint.limits->upper);
}

Way way_to_tip(const urdf::ModelInterface& model, const std::string& tip,
               const UrdfPlaces& places) {
  check_tree(model, places);
  return tip.empty() ? Search(model, places).longest() : named(model, tip, places);
}

}  // namespace limpid
