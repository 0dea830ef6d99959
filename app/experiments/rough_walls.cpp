#include "app/experiments/rough_walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/experiments/series.h"
#include "core/dynamics/arm.h"

namespace limpid {
namespace {

// Of friction: as stiff as the wall, up to 2000 N/m.
double spring_of(const RoughWalls& walls) { return std::min(walls.stiffness, 2000.0); }

// Which of the walls pushed like this: the one whose spring, so deep, gives that normal force.
std::size_t pusher(const RoughWalls& walls, const Vec3& force, const Vec3& tip,
                   const std::vector<Rub>& taken) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < static_cast<std::size_t>(walls.walls); ++i) {
    if (taken[i].normal > 0) continue;
    const double depth = std::max(0.0, kOutward[i].dot(kMeet - tip));
    const double off = std::abs(force.dot(kOutward[i]) - walls.stiffness * depth);
    if (off < least) {
      least = off;
      best = i;
    }
  }
  return best;
}

}  // namespace

Trial rubbing(const RoughWalls& walls, HandPath hand, const Parameters& p) {
  std::string text = "title = \"Rough walls\"\nabout = \"Planes that rub.\"\n";
  for (int i = 0; i < walls.walls; ++i) {
    const Vec3& n = kOutward[i];
    text += fmt::format(
        "\n[[plane]]\nname = \"wall {}\"\npoint = [{:.3f}, {:.3f}, {:.3f}]\n"
        "normal = [{:.1f}, {:.1f}, {:.1f}]\nstiffness = {:.1f}\n"
        "friction_static = {}\nfriction_kinetic = {}\n",
        i + 1, kMeet.x(), kMeet.y(), kMeet.z(), n.x(), n.y(), n.z(), walls.stiffness,
        walls.friction_static, walls.friction_kinetic);
  }
  return {"", plan_in(text, std::move(hand), p)};
}

std::vector<std::vector<Rub>> rubs_of(const Trial& trial, const RoughWalls& walls,
                                      const Session& s) {
  const Arm<kAnyDof> arm(trial.plan.arm);
  Arm<kAnyDof>::Frames frames;
  Jacobian<kAnyDof> J;
  std::vector<std::vector<Rub>> all;
  for (std::size_t k = 0; k + 1 < s.size(); ++k) {
    const Eigen::VectorXd x2 = vector_at(s, k, Column::proxy_position);
    arm.frames(x2, frames);
    const Vec3 tip = arm.tip(frames);
    arm.point_jacobian(frames, arm.dof() - 1, tip, J);
    const Vec3 moved = J * (vector_at(s, k + 1, Column::proxy_position) - x2);
    std::vector<Rub> rubs(static_cast<std::size_t>(walls.walls));
    const auto forces = s.at(k, Column::contact_force);
    for (std::size_t c = 0; c < static_cast<std::size_t>(kRowContacts); ++c) {
      const Vec3 force(forces[3 * c], forces[3 * c + 1], forces[3 * c + 2]);
      if (force.isZero(0)) continue;
      const std::size_t i = pusher(walls, force, tip, rubs);
      const Vec3& n = kOutward[i];
      rubs[i] = {force.dot(n), force - force.dot(n) * n, moved - moved.dot(n) * n};
    }
    all.push_back(std::move(rubs));
  }
  return all;
}

double given_by_friction(const RoughWalls& walls, const Rub& before, const Rub& now) {
  const double k_t = spring_of(walls);
  const double stored = (now.friction.squaredNorm() - before.friction.squaredNorm()) / (2 * k_t);
  return now.friction.dot(now.moved) + stored;
}

}  // namespace limpid
