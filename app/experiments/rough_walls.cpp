#include "app/experiments/rough_walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/series.h"
#include "core/dynamics/arm.h"

namespace limpid {
namespace {

// Of friction: as stiff as the wall, up to 2000 N/m.
double spring_of(const RoughWalls& walls) { return std::min(walls.stiffness, 2000.0); }

// How deep a wall is entered over a tick from one place of the tip to another [m]; where it is not,
// how far from it that stays, less than nothing.
double entered(int wall, const Vec3& from, const Vec3& to) {
  const Vec3& n = kOutward[wall];
  const double d = n.dot(kMeet - from), next = n.dot(kMeet - to);
  const double inside = (std::max(d, 0.0) + std::max(next, 0.0)) / 2;
  return inside > 0 ? inside : std::max(d, next);
}

// The forces of a row, which are in the order of the walls, each with the wall it is of: of as many
// walls as there are forces, those that are entered the deepest.
std::vector<std::pair<int, Vec3>> pushes(const std::vector<double>& depths,
                                         std::span<const double> columns) {
  std::vector<Vec3> forces;
  for (std::size_t c = 0; c < static_cast<std::size_t>(kRowContacts); ++c) {
    const Vec3 force(columns[3 * c], columns[3 * c + 1], columns[3 * c + 2]);
    if (!force.isZero(0)) forces.push_back(force);
  }
  std::vector<std::pair<int, Vec3>> pairs;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const auto deeper =
        std::ranges::count_if(depths, [&](double other) { return other > depths[i]; });
    if (static_cast<std::size_t>(deeper) >= forces.size() || pairs.size() == forces.size())
      continue;
    pairs.emplace_back(static_cast<int>(i), forces[pairs.size()]);
  }
  return pairs;
}

}  // namespace

Trial rubbing(const std::string& name, const RoughWalls& walls, HandPath hand,
              const Parameters& p) {
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
  return {name, plan_in(text, std::move(hand), p)};
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
    std::vector<double> depths;
    for (int i = 0; i < walls.walls; ++i) depths.push_back(entered(i, tip, arm.tip_at(next)));
    std::vector<Rub> rubs(static_cast<std::size_t>(walls.walls));
    for (const auto& [i, force] : pushes(depths, s.at(k, Column::contact_force))) {
      const Vec3& n = kOutward[i];
      rubs[static_cast<std::size_t>(i)] = {force.dot(n), force - force.dot(n) * n,
                                           moved - moved.dot(n) * n};
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
