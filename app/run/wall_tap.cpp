#include "app/run/wall_tap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/run/analysis.h"
#include "core/coupling/walls.h"
#include "devices/files/scene/scene_file.h"

namespace limpid {
namespace {

constexpr double kBefore = 0.1;  // the hand rests [s]

std::string wall_text(const TapPlace& place, double stiffness) {
  return fmt::format(
      "title = \"Wall\"\nabout = \"A flat wall before the tip.\"\n\n[[plane]]\nname = \"wall\"\n"
      "point = [{}, {}, {}]\nnormal = [{}, {}, {}]\nstiffness = {}\n",
      place.point.x(), place.point.y(), place.point.z(), place.out.x(), place.out.y(),
      place.out.z(), fmt::format("{:#.9g}", stiffness));
}

// Starts at rest before the wall, with the joints moved as little as possible.
RigStart before_the_wall(const ArmDescription& description, const TapPlace& place) {
  const Arm<kAnyDof> arm(description);
  Eigen::VectorXd x = place.x;
  for (int i = 0; i < 5; ++i) {
    const ArmAt at = arm_at(description, x);
    const Eigen::VectorXd lever = at.J.transpose() * place.out;
    x += lever * (WallTap::kAbove + place.depth(arm.tip_at(x))) / lever.squaredNorm();
  }
  RigStart start;
  start.x1 = start.x2 = x;
  start.v1 = start.v2 = start.f1_hat = Eigen::VectorXd::Zero(x.size());
  start.target = arm.tip_at(x);
  return start;
}

double way_down(const WallTap& tap, const Parameters& p) {
  return WallTap::kAbove + tap.press / p.hand_stiffness + tap.press / tap.wall;
}

}  // namespace

TapPlace tap_place(const ArmDescription& description, const Eigen::VectorXd& x,
                   const Parameters& p) {
  const ArmAt arm = arm_at(description, x);
  return {x, Arm<kAnyDof>(description).tip_at(x),
          least_damped(arm.J, device_damping(description, p))};
}

double bearable_press(const ArmDescription& arm, const TapPlace& place, const Parameters& p,
                      double wanted) {
  const Eigen::VectorXd lever = arm_at(arm, place.x).J.transpose() * place.out;
  double press = wanted;
  for (Eigen::Index i = 0; i < lever.size(); ++i) {
    const double effort = arm.joints[static_cast<std::size_t>(i)].effort;
    const double limit = std::isnan(p.torque_limit) ? effort : p.torque_limit;
    press = std::min(press, limit / 2 / std::max(std::abs(lever[i]), 1e-9));
  }
  return press;
}

double push_out(const Vec3& out, std::span<const double> forces) {
  double push = 0;
  for (std::size_t i = 0; i + 2 < forces.size(); i += 3) {
    push += out.dot(Vec3(forces[i], forces[i + 1], forces[i + 2]));
  }
  return push;
}

RunPlan wall_plan(const ArmDescription& arm, const TapPlace& place, double wall,
                  const Parameters& p) {
  RunPlan plan;
  plan.arm = arm;
  plan.document = parse_scene(wall_text(place, wall), "scene", {}, arm);
  plan.parameters = p;
  plan.start = before_the_wall(arm, place);
  plan.hand.tick = p.tick;
  return plan;
}

RunPlan tap_plan(const ArmDescription& arm, const TapPlace& place, const WallTap& tap,
                 const Parameters& p) {
  RunPlan plan = wall_plan(arm, place, tap.wall, p);
  const double down = way_down(tap, p), seconds = kBefore + down / WallTap::kSpeed + tap.hold;
  plan.rows = static_cast<std::uint64_t>(std::llround(seconds / p.tick));
  plan.hand.source = fmt::format("a tap of {} N at {} m/s", tap.press, WallTap::kSpeed);
  for (std::uint64_t k = 0; k < plan.rows; ++k) {
    const double t = static_cast<double>(k) * p.tick;
    const double way = (t - kBefore) * WallTap::kSpeed;
    const bool moves = way > 0 && way < down;
    plan.hand.time.push_back(t);
    plan.hand.position.push_back(plan.start->target - std::clamp(way, 0.0, down) * place.out);
    plan.hand.velocity.push_back(moves ? Vec3(-WallTap::kSpeed * place.out) : Vec3(0, 0, 0));
    plan.hand.grip.push_back(1);
  }
  return plan;
}

WallMeter::WallMeter(const ArmDescription& arm, const Object& wall, double T, std::uint64_t from)
    : arm_(arm),
      point_(wall.pose.translation()),
      out_(std::get<Plane>(wall.shape).normal),
      stiffness_(wall.material.stiffness),
      fast_(WallTap::kFast, 1 / T),
      from_(from) {}

void WallMeter::add(const RowLayout& layout, std::span<const double> row) {
  const double push = push_out(out_, layout.in(row, Column::contact_force));
  const double trembling = fast_(push);
  if (row_++ < from_) return;
  fast2_ += trembling * trembling;
  force_ += push;
  const auto x = layout.in(row, Column::device_position);
  const Vec3 tip =
      arm_.tip_at(Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
  depth_ += std::max(0.0, out_.dot(point_ - tip));
}

double WallMeter::felt() const { return depth_ > 0 ? force_ / depth_ / stiffness_ : 0; }

double WallMeter::rattle() const {
  return row_ > from_ ? std::sqrt(fast2_ / static_cast<double>(row_ - from_)) : 0;
}

WallMeter tap_meter(const RunPlan& plan, const WallTap& tap) {
  const auto judged = static_cast<std::uint64_t>(std::llround(tap.judged / plan.parameters.tick));
  return {plan.arm, plan.document.scene.objects.front(), plan.parameters.tick,
          plan.rows - std::min(plan.rows, judged)};
}

}  // namespace limpid
