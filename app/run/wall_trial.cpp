#include "app/run/wall_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <vector>

#include "app/run/analysis.h"
#include "app/run/wall_tap.h"
#include "core/dynamics/arm.h"
#include "core/math/eigen.h"
#include "core/math/high_pass.h"
#include "devices/files/scene/scene_document.h"

namespace limpid {
namespace {

constexpr double kGrips[] = {300, 3000};  // [N/m]
constexpr double kPushed = 4;             // of the hand while it is still [N]
constexpr double kDeepest = 0.005;        // in the wall [m]
constexpr double kStillFor = 0.1;         // the hand is still [s]
constexpr double kHold = 1;               // [s]
constexpr double kJudged = 0.3;           // last part of each hold [s]
constexpr double kPressing = 1;           // duration of a slow press [s]
constexpr int kHalvings = 8;
constexpr double kSameDirection = 0.95;  // cosine of the angle between two
constexpr double kNoMobility = 1e-9;     // beside the largest: round-off

// A wall, and the hand that presses it.
struct Press {
  TapPlace place;
  double grip;  // [N/m]
};

// Point of the hand's path, below its start. The hand rests at each of them: a sudden
// turn would shake the tip by itself.
struct Waypoint {
  double t, down;  // [s, m]
};

enum class Judged : std::uint8_t { trembling, all };

struct Phase {
  double from, to;  // [s]
  Judged judged;
  const char* name;
};

struct PressMotion {
  std::vector<Waypoint> points;
  std::vector<Phase> phases;

  void go(double seconds, double down) {
    points.push_back({points.empty() ? 0 : points.back().t + seconds, down});
  }
  double now() const { return points.back().t; }
};

PressMotion motion_to(double down, bool felt) {
  PressMotion m;
  const auto hold = [&](const char* name) {
    m.go(kHold, down);
    m.phases.push_back({m.now() - kJudged, m.now(), felt ? Judged::all : Judged::trembling, name});
  };
  const double quick = 1.5 * down / WallTap::kSpeed;  // it is fastest in the middle
  m.go(0, 0);
  m.go(kStillFor, 0);
  m.go(quick, down);
  hold("tapped");
  m.go(quick, 0);
  m.go(kStillFor, 0);
  const double began = m.now();
  m.go(kPressing, down);
  m.phases.push_back({began, m.now(), Judged::trembling, "pressed slowly"});
  hold("pressed slowly");
  return m;
}

RunPlan press_plan(const ArmDescription& arm, const Press& press, double wall, Parameters p,
                   PressMotion& motion) {
  p.hand_stiffness = press.grip;
  const double force = std::min(bearable_press(arm, press.place, p, kPushed), kDeepest * wall);
  motion = motion_to(WallTap::kAbove + force / press.grip + force / wall, !softens(info(p.kind)));
  RunPlan plan = wall_plan(arm, press.place, wall, p);
  plan.rows = static_cast<std::uint64_t>(std::llround(motion.now() / p.tick));
  plan.hand.source = "a wall tapped, and pressed slowly";
  const Vec3 in = -press.place.out;
  std::size_t leg = 0;
  for (std::uint64_t k = 0; k < plan.rows; ++k) {
    const double t = static_cast<double>(k) * p.tick;
    while (leg + 2 < motion.points.size() && t >= motion.points[leg + 1].t) ++leg;
    const Waypoint &a = motion.points[leg], &b = motion.points[leg + 1];
    const double duration = b.t - a.t, u = std::clamp((t - a.t) / duration, 0.0, 1.0);
    const double way = b.down - a.down;
    plan.hand.time.push_back(t);
    plan.hand.position.push_back(plan.start->target + (a.down + u * u * (3 - 2 * u) * way) * in);
    plan.hand.velocity.push_back(6 * u * (1 - u) / duration * way * in);
    plan.hand.grip.push_back(1);
  }
  return plan;
}

// Means over a phase.
class PhaseMeter {
 public:
  explicit PhaseMeter(const Phase& phase) : phase_(phase) {}

  void add(double t, double trembling, double push, double depth) {
    if (t < phase_.from || t >= phase_.to) return;
    ++ticks_;
    tremble2_ += trembling * trembling;
    push_ += push;
    touched_ += depth > 0 ? 1 : 0;
    depth_ += std::max(0.0, depth);
  }
  bool touched() const { return touched_ > 0; }
  // Says what was wrong with a wall of this stiffness [N/m]; empty: nothing. step: the encoders' at
  // the tip [m].
  std::string fault(double wall, double step) const {
    const double tremble = std::sqrt(tremble2_ / std::max(1.0, ticks_));
    if (tremble > HeldWall::kChatter) {
      return fmt::format("{}, the tip trembles at {:.0f} mm/s", phase_.name, 1e3 * tremble);
    }
    // A hand may not get there, or swing with a heavy arm.
    if (phase_.judged != Judged::all || touched_ < ticks_ || !(depth_ > 0)) return {};
    const double felt = push_ / depth_ / wall;
    if (std::abs(felt - 1) > HeldWall::kFelt + step * ticks_ / depth_) {
      return fmt::format("{}, it is felt with {:.0f} % of its stiffness", phase_.name, 100 * felt);
    }
    return {};
  }

 private:
  Phase phase_;
  double ticks_ = 0, touched_ = 0, tremble2_ = 0, push_ = 0, depth_ = 0;
};

// Outcome of one press on a wall.
struct Pressed {
  bool reached = true;
  std::string fault = {};  // empty: none
};

Pressed press_wall(const ArmDescription& description, const Press& press, double wall,
                   const Parameters& p, const std::atomic<bool>* stop) {
  PressMotion motion;
  const RunPlan plan = press_plan(description, press, wall, p, motion);
  const Arm<kAnyDof> arm(description);
  const RowLayout layout = plan.layout();
  const Eigen::VectorXd lever = arm_at(description, press.place.x).J.transpose() * press.place.out;
  const double step = p.encoder_step * lever.lpNorm<1>();
  std::vector<PhaseMeter> meters(motion.phases.begin(), motion.phases.end());
  HighPass fast(WallTap::kFast, 1 / p.tick);
  Vec3 before = plan.start->target;
  double t = 0, given = 0;
  const RunEnd end = simulate(plan, {.stop = stop}, [&](std::span<const double> row, LaneChanges) {
    const auto x = layout.in(row, Column::device_position);
    const Vec3 tip = arm.tip_at(
        Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
    // Along the wall joints may stick and slip by their own friction.
    const double trembling = fast(press.place.out.dot(tip - before) / p.tick);
    before = tip;
    const double push = push_out(press.place.out, layout.in(row, Column::contact_force));
    const double depth = press.place.depth(tip);
    for (PhaseMeter& meter : meters) meter.add(t, trembling, push, depth);
    given = std::max(given, layout.in(row, Column::energy_port)[0]);
    t += p.tick;
    return true;
  });
  if (end.diverged) return {.fault = "the loop becomes unstable"};
  for (const PhaseMeter& meter : meters) {
    if (std::string fault = meter.fault(wall, step); !fault.empty()) return {.fault = fault};
  }
  if (info(p.kind).keeps_ledger() && given > p.energy) {
    return {.fault = fmt::format("the hand is given {:.3g} mJ", 1e3 * given)};
  }
  return {.reached = std::ranges::any_of(meters, &PhaseMeter::touched)};
}

std::vector<Press> presses(const ArmDescription& description, const Eigen::VectorXd& x,
                           const Parameters& p) {
  const ArmAt arm = arm_at(description, x);
  const Mat3 mobility = arm.J * arm.M.ldlt().solve(arm.J.transpose());
  const auto modes = symmetric_eigen(Eigen::MatrixXd(mobility));
  TapPlace place = tap_place(description, x, p);
  std::vector<Vec3> outs{place.out};
  for (int i = 0; i < 3; ++i) {
    const Vec3 out = modes.vectors.col(i);
    const bool other = std::ranges::none_of(
        outs, [&](const Vec3& each) { return std::abs(each.dot(out)) > kSameDirection; });
    if (other && modes.values[i] > kNoMobility * modes.values[2]) outs.push_back(out);
  }
  std::vector<double> grips{p.hand_stiffness};
  for (const double grip : kGrips) {
    if (grip != p.hand_stiffness) grips.push_back(grip);
  }
  std::vector<Press> all;
  for (const Vec3& out : outs) {
    place.out = out;
    for (const double grip : grips) all.push_back({place, grip});
  }
  return all;
}

}  // namespace

bool softens(const LawInfo& law) { return law.knows_link() && !law.observes; }

WallTrial try_wall(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p,
                   double named, const std::atomic<bool>* stop) {
  WallTrial trial{named, 0, {}};
  const std::vector<Press> all = presses(arm, x, p);
  double wall = std::min(named, scene_limits::kStiffness.maximum);
  for (int i = 0; i <= kHalvings; ++i, wall /= 2) {
    Pressed pressed;
    bool reached = false;
    for (const Press& press : all) {
      if (stop != nullptr && *stop) return trial;
      try {
        pressed = press_wall(arm, press, wall, p, stop);
      } catch (const std::exception& e) {  // an arm or scene that cannot be run
        trial.fault = e.what();
        return trial;
      }
      reached = reached || pressed.reached;
      if (pressed.fault.empty()) continue;
      trial.fault =
          fmt::format("{:.0f} N/m in a grip of {:.0f} N/m: {}", wall, press.grip, pressed.fault);
      break;
    }
    if (!pressed.fault.empty()) continue;
    if (reached) {
      trial.held = wall;
    } else {
      trial.fault = fmt::format("no simulated hand reaches a wall of {:.0f} N/m", wall);
    }
    break;
  }
  return trial;
}

}  // namespace limpid
