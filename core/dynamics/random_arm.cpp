#include "core/dynamics/random_arm.h"

#include <algorithm>
#include <string>

#include "core/dynamics/random.h"

namespace limpid {

ArmDescription random_arm(int dof, unsigned seed, Slides slides) {
  Random random(seed);
  ArmDescription arm;
  arm.name = "random";
  for (int i = 0; i < dof; ++i) {
    const std::string number = std::to_string(i + 1);
    Joint joint;
    joint.name = "joint " + number;
    joint.origin.linear() = random.rotation();
    joint.origin.translation() = (i == 0 ? 0.02 : 0.1) * random.direction();
    joint.axis = random.direction();
    joint.effort = random.between(0.4, 0.8);
    joint.damping = 0.012;
    if (slides == Slides::all || (slides == Slides::some && i % 3 == 1)) {
      joint.kind = Joint::Kind::prismatic;
    }
    arm.joints.push_back(joint);

    Link link;
    link.name = "link " + number;
    link.mass = random.between(0.03, 0.07);
    link.com = random.point(0.03);
    for (int k = 0; k < 4; ++k) {
      const Vec3 r = random.point(0.04);
      link.inertia += link.mass / 4 * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
    }
    arm.links.push_back(link);
    arm.frames.push_back({link.name, i, Pose::Identity()});
  }
  arm.tip.translation() = 0.1 * random.direction();
  return arm;
}

ArmDescription weighing(ArmDescription arm, double mass) {
  double now = 0;
  for (const Link& link : arm.links) now += link.mass;
  const double heavier = mass / now, longer = power(heavier, 1.0 / 3);
  // A robot of 18 kg has about 0.2 N m s/rad where a desktop device of 0.3 kg has 0.012.
  const double stronger = std::max(1.0, heavier * longer);
  const double stiffer = std::max(1.0, power(heavier, 0.7));
  for (Joint& joint : arm.joints) {
    joint.origin.translation() *= longer;
    joint.effort *= stronger;
    joint.damping *= stiffer;
  }
  for (Link& link : arm.links) {
    link.mass *= heavier;
    link.com *= longer;
    link.inertia *= heavier * longer * longer;
  }
  arm.tip.translation() *= longer;
  return arm;
}

}  // namespace limpid
