#include "app/experiments/rough_walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "app/experiments/series.h"
#include "core/dynamics/arm.h"

namespace limpid {
namespace {

// Of friction: as stiff as the wall, up to 2000 N/m.
double spring_of(const RoughWalls& walls) { return std::min(walls.stiffness, 2000.0); }

// Mean spring force of each wall over a tick from one place of the tip to another; less than
// nothing where the tip stays outside.
std::vector<double> springs(const RoughWalls& walls, const Vec3& from, const Vec3& to) {
  std::vector<double> mean;
  for (std::size_t i = 0; i < static_cast<std::size_t>(walls.walls); ++i) {
    const double d = kOutward[i].dot(kMeet - from), next = kOutward[i].dot(kMeet - to);
    const double inside = (std::max(d, 0.0) + std::max(next, 0.0)) / 2;
    mean.push_back(inside > 0 ? walls.stiffness * inside : -1);
  }
  return mean;
}

// The forces of a row, which are in the order of the walls, each with the wall it is of: of all
// choices the one that comes nearest to what the springs do.
std::vector<std::pair<std::size_t, Vec3>> pushes(const std::vector<double>& springs,
                                                 std::span<const double> columns) {
  std::vector<Vec3> forces;
  for (std::size_t c = 0; c < static_cast<std::size_t>(kRowContacts); ++c) {
    const Vec3 force(columns[3 * c], columns[3 * c + 1], columns[3 * c + 2]);
    if (!force.isZero(0)) forces.push_back(force);
  }
  std::vector<std::pair<std::size_t, Vec3>> best;
  double least = std::numeric_limits<double>::infinity();
  for (unsigned chosen = 0; chosen < 1u << springs.size(); ++chosen) {
    if (static_cast<std::size_t>(std::popcount(chosen)) != forces.size()) continue;
    std::vector<std::pair<std::size_t, Vec3>> choice;
    double off = 0;
    for (std::size_t i = 0; i < springs.size(); ++i) {
      if ((chosen >> i & 1u) == 0) {
        off += std::max(0.0, springs[i]);
        continue;
      }
      choice.emplace_back(i, forces[choice.size()]);
      off += springs[i] < 0 ? 1e3 : std::abs(choice.back().second.dot(kOutward[i]) - springs[i]);
    }
    if (off < least) {
      least = off;
      best = std::move(choice);
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
        "normal = [{:.1f}, {:.1f}, {:.1f}]\nstiffness = {:.1f}\n",
        i + 1, kMeet.x(), kMeet.y(), kMeet.z(), n.x(), n.y(), n.z(), walls.stiffness);
  }
  Trial trial{"", plan_in(text, std::move(hand), p)};
  for (Plane& plane : trial.plan.scene.planes) {
    plane.material.friction_static = walls.friction_static;
    plane.material.friction_kinetic = walls.friction_kinetic;
  }
  trial.keep = false;  // the scene's text knows nothing of friction
  return trial;
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
    const Eigen::VectorXd next = vector_at(s, k + 1, Column::proxy_position);
    const Vec3 moved = J * (next - x2);
    const std::vector<double> pushing = springs(walls, tip, arm.tip_at(next));
    std::vector<Rub> rubs(static_cast<std::size_t>(walls.walls));
    for (const auto& [i, force] : pushes(pushing, s.at(k, Column::contact_force))) {
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

double slipped(const RoughWalls& walls, const Rub& before, const Rub& now) {
  return (now.moved + (now.friction - before.friction) / spring_of(walls)).norm();
}

}  // namespace limpid
