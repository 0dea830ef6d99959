// Section 4.2, (22)-(25): where the loop is stable, over eta and how stiff the hand holds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/excitation.h"
#include "app/experiments/series.h"
#include "app/run/analysis.h"
#include "app/run/grip_limit.h"
#include "core/dynamics/arm.h"

namespace limpid {
namespace {

constexpr double kEtaStep = 0.05;
constexpr double kPaperTick = 1e-3, kFineTick = 1e-4;  // [s]
constexpr double kUsualGrip = 3000;                    // no hand is stiffer [N/m]
constexpr double kKick = 2e-5;  // how far the hand jumps at first, in each direction [m]
constexpr double kSeconds = 1.5;
constexpr double kPhysicsStep = 5e-5;  // of the device's integration [s]

constexpr const char* kFree = R"(title = "Free space"
about = "Nothing to touch."
)";

std::vector<double> etas() {
  std::vector<double> values;
  for (int i = 1; i <= 20; ++i) values.push_back(kEtaStep * i);
  return values;
}
std::vector<double> grips() {
  std::vector<double> values;
  for (int i = 0; i <= 12; ++i) values.push_back(30 * std::pow(10, i / 4.0));
  return values;
}

Vec3 start() { return {0.19, 0, 0}; }

Parameters parameters(double T, double eta, double grip) {
  Parameters p;
  p.tick = T;
  p.substeps = static_cast<int>(std::lround(T / kPhysicsStep));
  p.eta = eta;
  p.hand_stiffness = grip;
  p.hand_damping = 0;
  return p;
}

// At rest, then the hand jumps within a tick and stays.
Trial kicked(double T, double eta, double grip) {
  HandPath hand;
  hand.time = {0, T};
  hand.position = {start(), start() + kKick * Vec3::Ones()};
  hand.velocity.assign(2, Vec3::Zero());
  hand.grip.assign(2, 1);
  hand.source = "a jump";
  RunPlan plan = plan_in(kFree, std::move(hand), parameters(T, eta, grip));
  plan.rows = static_cast<std::uint64_t>(std::llround(kSeconds / T));
  return {fmt::format("tick-{}-eta-{:.2f}-grip-{:.0f}", T, eta, grip), std::move(plan), false};
}

// Speeds over spans of a twentieth of the run: growing, or not dying away, is unstable.
bool stable(const TrialResult& result) {
  if (result.end.diverged) return false;
  const Session& s = result.session;
  const std::size_t spans = 20, rows = s.size() / spans;
  std::vector<double> speed;
  for (std::size_t i = 0; i < spans; ++i) {
    speed.push_back(rms_norm(s, Column::device_velocity, i * rows, (i + 1) * rows));
  }
  const bool gone = speed.back() < 1e-6 * speed.front();
  return gone || (speed.back() < speed.front() && speed.back() < speed[spans / 2]);
}

struct Point {
  double eta = 0, grip = 0;
  bool stable = false;
};

std::vector<Point> simulate_map(Laboratory& lab, double T) {
  std::vector<Point> points;
  std::vector<Trial> trials;
  for (const double grip : grips()) {
    for (const double eta : etas()) {
      points.push_back({eta, grip, false});
      trials.push_back(kicked(T, eta, grip));
    }
  }
  lab.run(trials, [&](std::size_t i, const TrialResult& r) { points[i].stable = stable(r); });
  return points;
}

// What theory says of the arm at the start.
class Theory {
 public:
  Theory() : arm_(kicked(1e-3, 1, 300).plan.arm), x_(rest_at(arm_, start()).x1) {
    const Arm<kAnyDof> arm(arm_);
    Arm<kAnyDof>::Frames frames;
    arm.frames(x_, frames);
    Jacobian<kAnyDof> J;
    arm.point_jacobian(frames, arm.dof() - 1, arm.tip(frames), J);
    JJ_ = J.transpose() * J;
    M_L_ = (1 + Parameters{}.inertia_ratio) * inertia_at(arm_, x_);
    b_d_.resize(arm.dof());
    for (int i = 0; i < arm.dof(); ++i) b_d_[i] = arm_.joints[static_cast<std::size_t>(i)].damping;
  }
  // (25).
  double pr() const { return analyze(arm_, x_, Parameters{}, std::nullopt).eta_min; }
  // The same with the device's damping alone.
  double pr_without_proxy() const {
    Parameters p;
    p.b_v = 0;
    return analyze(arm_, x_, p, std::nullopt).eta_min;
  }
  // Routh's limit of the locked system in a grip.
  double locked(double grip) const {
    return analyze(arm_, x_, parameters(1e-3, 1, grip), std::nullopt).eta_min_grip;
  }
  // The same with the proxy behind its spring.
  double compliant(double grip) const {
    return eta_min_compliant(M_L_, b_d_, Parameters{}, grip * JJ_);
  }

 private:
  ArmDescription arm_;
  Eigen::VectorXd x_, b_d_;
  Eigen::MatrixXd M_L_, JJ_;
};

// How far the furthest point lies on the wrong side of a limit.
template <class Limit>
double misplaced(const std::vector<Point>& points, double stiffest, const Limit& limit) {
  double worst = 0;
  for (const Point& p : points) {
    if (p.grip > stiffest) continue;
    const double beyond = p.eta - limit(p.grip);
    worst = std::max(worst, p.stable ? -beyond : beyond);
  }
  return worst;
}

FigurePanel panel_of(const std::vector<Point>& points, double T, const Theory& theory) {
  FigurePanel panel;
  panel.title = fmt::format("Undamped grip, ticks of {} ms", 1e3 * T);
  panel.x_label = "grip stiffness [N/m]";
  panel.y_label = "eta [-]";
  panel.log_x = true;
  panel.x_range = {20, 45000};
  panel.y_range = {0, 1.05};
  Series stable{"stable", kProxyInk, Series::Style::points, {}};
  Series unstable{"unstable", kContactInk, Series::Style::points, {}};
  for (const Point& p : points) {
    (p.stable ? stable : unstable).points.push_back({p.grip, p.eta});
  }
  Series pr{"PR (25)", kNeutralInk, Series::Style::dashed, {}};
  Series locked{"Routh, locked", kHandInk, Series::Style::line, {}};
  Series compliant{"Routh, proxy on its spring", kEnergyInk, Series::Style::line, {}};
  for (double grip = 20; grip < 45000; grip *= 1.15) {
    pr.points.push_back({grip, theory.pr()});
    locked.points.push_back({grip, theory.locked(grip)});
    compliant.points.push_back({grip, theory.compliant(grip)});
  }
  panel.series = {stable, unstable, pr, locked, compliant};
  return panel;
}

}  // namespace

Outcome eta_min_map(Laboratory& lab) {
  const Theory theory;
  const std::vector<Point> fine = simulate_map(lab, kFineTick);
  const std::vector<Point> paper = simulate_map(lab, kPaperTick);

  Outcome outcome;
  outcome.figure.title = "Where the loop is stable: eta against the grip";
  outcome.figure.caption = fmt::format(
      "Built-in arm, full nonlinear loop at the paper's gains, tip {} m ahead; the hand jumps by "
      "{:.0f} um along each axis and holds without damping; stable: the motion dies away within "
      "{} s. Above k_vc / b_v = {:.0f} rad/s, in stiff grips, the proxy's damper is no longer felt "
      "through the coupling's spring, and the limit rises from (25) towards (25) with b_d alone, "
      "{:.2f}. There, ticks of 1 ms differ from the continuous theory.",
      start().x(), 1e6 * kKick, kSeconds, Parameters{}.k_vc / Parameters{}.b_v,
      theory.pr_without_proxy());
  outcome.figure.columns = 2;
  outcome.figure.panels = {panel_of(fine, kFineTick, theory), panel_of(paper, kPaperTick, theory)};

  const auto locked = [&](double grip) { return theory.locked(grip); };
  const auto compliant = [&](double grip) { return theory.compliant(grip); };
  const std::string locked_text =
      fmt::format("Routh's limit of the locked system, grips to {} N/m, in eta", kUsualGrip);
  outcome.checks = {
      at_most("ticks of 0.1 ms: furthest point on the wrong side of Routh's limit with the proxy "
              "on its spring, all grips, in eta",
              misplaced(fine, HUGE_VAL, compliant), kEtaStep),
      at_most("ticks of 0.1 ms: furthest point on the wrong side of " + locked_text,
              misplaced(fine, kUsualGrip, locked), kEtaStep),
      at_most("ticks of 1 ms: furthest point on the wrong side of " + locked_text,
              misplaced(paper, kUsualGrip, locked), kEtaStep)};
  return outcome;
}

}  // namespace limpid
