// Friction: sticking, slipping, edges and corners, and that it only ever takes energy.
#include "app/experiments/friction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/signals.h"
#include "core/dynamics/arm.h"
#include "core/math/elementary.h"

namespace limpid {

namespace {

// Stiffness of the friction's spring: the wall's, at most 2000 N/m.
double spring_of(const RoughWalls& walls) { return std::min(walls.stiffness, 2000.0); }

// Mean depth of the tip in a wall over a tick from `from` to `to` [m]; outside, its negative
// distance.
double entered(int wall, const Vec3& from, const Vec3& to) {
  const Vec3& n = kOutward[wall];
  const double d = n.dot(kMeet - from), next = n.dot(kMeet - to);
  const double inside = (std::max(d, 0.0) + std::max(next, 0.0)) / 2;
  return inside > 0 ? inside : std::max(d, next);
}

// The forces of a row, each with its wall. Forces are in the order of the walls; those entered
// deepest have them.
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

constexpr double kStatic = 0.5, kKinetic = 0.3;
constexpr double kWall = 1000, kPress = 3;  // [N/m], [N]
constexpr double kDrag = 0.03;              // there and back [m]
constexpr double kDown = 0.5, kEnd = 3.5;   // [s]
constexpr double kSlipping = 5e-3;          // the tip surely slips above this [m/s]
constexpr double kEdgeWall = 3000, kEdgePress = 5, kEdgeEnd = 1.6;
constexpr double kStrong = 100;  // motors that never meet their limit [N m]

struct Case {
  std::string label;
  const char* ink;
  RoughWalls walls;
};

std::vector<Case> drags() {
  return {{fmt::format("{} static, {} kinetic", kStatic, kKinetic),
           kProxyInk,
           {.stiffness = kWall, .friction_static = kStatic, .friction_kinetic = kKinetic}},
          {"0.2 for both",
           kDeviceInk,
           {.stiffness = kWall, .friction_static = 0.2, .friction_kinetic = 0.2}},
          {"smooth", kNeutralInk, {.stiffness = kWall}}};
}

// Sideways position of the hand at t [m].
double aside(double t) {
  const double half = (kEnd - kDown) / 2;
  return kDrag * (minimum_jerk((t - kDown) / half) - minimum_jerk((t - kDown - half) / half));
}

Trial drag(const ExperimentArm& on, const RoughWalls& walls) {
  Parameters p = on.settings;
  p.kind = CouplingKind::predictive;
  const double deep = kPress / p.hand_stiffness + kPress / kWall;
  const auto at = [deep](double t) {
    return Vec3(kMeet + Vec3(0, aside(t), 0.005 - (0.005 + deep) * minimum_jerk(t / kDown)));
  };
  const std::string source = fmt::format("pressing {} N, {} m aside and back", kPress, kDrag);
  return rubbing(on.description,
                 fmt::format("drag-{}-{}", walls.friction_static, walls.friction_kinetic), walls,
                 hand_path(source, p.tick, kEnd, at), p);
}

// Trial that presses into an edge or a corner and wanders about in it. `motors`: their limit [N m].
Trial wander(const ExperimentArm& on, const RoughWalls& walls, double eta, double grip,
             double motors) {
  Parameters p = on.settings;
  p.kind = CouplingKind::predictive;
  p.eta = eta;
  p.hand_stiffness = grip;
  p.torque_limit = motors;
  const double press = kEdgePress / grip + kEdgePress / walls.stiffness;
  Vec3 in = Vec3::Zero();
  for (int i = 0; i < walls.walls; ++i) in -= kOutward[i];
  in.normalize();
  const auto at = [press, in](double t) {
    const double part = minimum_jerk(t / 0.3);
    const Vec3 about(sine(6 * t), sine(9 * t), cosine(7 * t));
    return Vec3(kMeet - 0.01 * (1 - part) * in + part * press * in +
                0.5 * press * minimum_jerk((t - 0.3) / 0.3) * about);
  };
  const std::string source = fmt::format("wandering in {} walls, {:.6g} m", walls.walls, press);
  const std::string name =
      fmt::format("{}-{}-eta-{}-{}", walls.walls == 2 ? "edge" : "corner", walls.friction_static,
                  eta, std::isnan(motors) ? "own-motors" : "strong-motors");
  return rubbing(on.description, name, walls, hand_path(source, p.tick, kEdgeEnd, at), p);
}

double ratio(const Rub& rub) { return rub.normal > 0 ? rub.friction.norm() / rub.normal : 0; }

// Friction over all ticks and walls of a trial.
struct Verdict {
  double given = 0;         // most in a tick [J]
  double beyond = 0;        // most over the friction cone, of the normal force [-]
  double off_kinetic = 0;   // largest error of the force while slipping, of the kinetic force [-]
  double crept = 0;         // most that the tip moved besides the spring while sticking [m]
  double broke_away = 0;    // highest tangential over normal force [-]
  int stuck = 0, slid = 0;  // ticks judged as sticking, as slipping
  int touched = 0;          // ticks in which all walls were touched
  std::vector<double> sum;  // given up to each tick [J]
};

Verdict judge(const RoughWalls& walls, const std::vector<std::vector<Rub>>& rubs, double tick) {
  Verdict v;
  double sum = 0;
  std::vector<Rub> before(static_cast<std::size_t>(walls.walls));
  std::vector<double> last(before.size());
  for (const auto& now : rubs) {
    v.touched += std::ranges::all_of(now, [](const Rub& rub) { return rub.normal > 0; });
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double given = given_by_friction(walls, before[i], now[i]);
      v.given = worse(v.given, given);
      sum += given;
      if (now[i].normal == 0) continue;
      v.broke_away = worse(v.broke_away, ratio(now[i]));
      v.beyond = worse(v.beyond, ratio(now[i]) - walls.friction_static);
      const double slip = slipped(walls, before[i], now[i]);
      if (slip > kSlipping * tick && last[i] > kSlipping * tick && walls.friction_kinetic > 0) {
        ++v.slid;
        v.off_kinetic = worse(v.off_kinetic, std::abs(ratio(now[i]) / walls.friction_kinetic - 1));
      }
      last[i] = slip;
      // Strictly inside both cones the tip cannot slip.
      if (ratio(now[i]) < 0.99 * walls.friction_kinetic && before[i].normal > 0) {
        ++v.stuck;
        v.crept = worse(v.crept, slip);
      }
    }
    before = now;
    v.sum.push_back(sum);
  }
  return v;
}

struct Dragged {
  Case what;
  TrialResult result;
  std::vector<std::vector<Rub>> rubs;
  Verdict verdict;
};

std::vector<Dragged> drag_all(TrialRunner& lab) {
  const std::vector<Case> cases = drags();
  std::vector<Trial> trials;
  for (const Case& c : cases) trials.push_back(drag(lab.arm(), c.walls));
  std::vector<TrialResult> results = lab.run(trials);
  std::vector<Dragged> all;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto rubs = rubs_of(trials[i], cases[i].walls, results[i].session);
    const Verdict verdict = judge(cases[i].walls, rubs, results[i].session.info.tick);
    all.push_back({cases[i], std::move(results[i]), rubs, verdict});
  }
  return all;
}

FigurePanel ratio_panel(const std::vector<Dragged>& all) {
  FigurePanel panel{
      .title = "Tangential force divided by normal force, while the hand moves sideways",
      .x_label = "sideways distance of the hand from the place where it pressed [mm]",
      .y_label = "tangential / normal force [-]"};
  for (const Dragged& d : all) {
    Series line{d.what.label, d.what.ink, Series::Style::line, {}};
    for (std::size_t k = 0; k < d.rubs.size(); k += 2) {
      const Rub& rub = d.rubs[k].front();
      const double t = static_cast<double>(k) * d.result.session.info.tick;
      if (t < kDown || rub.normal == 0) continue;
      line.points.push_back({1e3 * aside(t), -rub.friction.y() / rub.normal});
    }
    panel.series.push_back(line);
  }
  for (const double mu : {kStatic, -kStatic, kKinetic, -kKinetic}) {
    const bool named = mu == kStatic;
    panel.series.push_back({named ? "static and kinetic coefficient" : "",
                            kContactInk,
                            Series::Style::dashed,
                            {{-1, mu}, {31, mu}}});
  }
  panel.x_range = {-1, 31};
  panel.y_range = {-0.6, 0.6};
  return panel;
}

FigurePanel stick_panel(const Trial& trial, const Dragged& d) {
  FigurePanel panel{.title = fmt::format("Stick and slip: {}", d.what.label),
                    .x_label = "time [s]",
                    .y_label = "sideways position [mm]"};
  const Session& s = d.result.session;
  const auto tip = [&](Column c) {
    return [&, c](std::size_t k) { return 1e3 * tip_at(trial.plan.arm, vector_at(s, k, c)).y(); };
  };
  panel.series = {
      over_time(s, "hand", kHandInk, Series::Style::line,
                [&](auto k) { return 1e3 * s.at(k, Column::hand_target)[1]; }),
      over_time(s, "device", kDeviceInk, Series::Style::line, tip(Column::device_position), 700),
      over_time(s, "proxy", kProxyInk, Series::Style::dashed, tip(Column::proxy_position), 700)};
  panel.x_range = {kDown, kEnd};
  return panel;
}

FigurePanel taken_panel(const std::vector<Dragged>& all) {
  FigurePanel panel{
      .title = "Energy that friction gave: work of its force plus energy in its spring",
      .x_label = "time [s]",
      .y_label = "energy [mJ]"};
  for (const Dragged& d : all) {
    const Session& s = d.result.session;
    panel.series.push_back(over_time(s, d.what.label, d.what.ink, Series::Style::line, [&](auto k) {
      return 1e3 * d.verdict.sum[std::min(k, d.verdict.sum.size() - 1)];
    }));
  }
  panel.x_range = {0, kEnd};
  return panel;
}

// Edge and corner with motors of one limit: a panel of E_c, and its checks.
FigurePanel between_walls(TrialRunner& lab, double motors, const std::string& which,
                          std::vector<Check>& checks) {
  FigurePanel panel{.title = fmt::format("Tip rubbed along walls of {} N/m, {}", kEdgeWall, which),
                    .x_label = "time [s]",
                    .y_label = "E_c [mJ]"};
  std::vector<RoughWalls> walls;
  std::vector<Trial> trials;
  for (const int count : {2, 3}) {
    for (const double mu : {0.0, 0.5, 1.0}) {
      for (const auto& [eta, grip] : {std::pair(0.3, 300.0), {1.0, 3000.0}}) {
        walls.push_back({count, kEdgeWall, mu, mu});
        trials.push_back(wander(lab.arm(), walls.back(), eta, grip, motors));
      }
    }
  }
  double energy = 0, given = 0, beyond = 0, touched = kEdgeEnd;
  const std::vector<TrialResult> results = lab.run(trials);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const Session& s = results[i].session;
    const Verdict v = judge(walls[i], rubs_of(trials[i], walls[i], s), s.info.tick);
    given = worse(given, v.given);
    beyond = worse(beyond, v.beyond);
    touched = worse_low(touched, v.touched * s.info.tick);
    for (std::size_t k = 0; k < s.size(); ++k) {
      energy = worse(energy, s.at(k, Column::energy_total)[0]);
    }
    if (trials[i].plan.parameters.hand_stiffness != 300) continue;
    const char* inks[] = {kProxyInk, kDeviceInk, kHandInk, kContactInk, kEnergyInk, kFamilyInk[5]};
    panel.series.push_back(
        over_time(s,
                  fmt::format("{}, coefficient {}", walls[i].walls == 2 ? "edge" : "corner",
                              walls[i].friction_static),
                  inks[i / 2], walls[i].walls == 2 ? Series::Style::line : Series::Style::dashed,
                  [&](auto k) { return 1e3 * s.at(k, Column::energy_total)[0]; }));
  }
  panel.x_range = {0, kEdgeEnd};
  const std::string where = "edge and corner, " + which + ": ";
  checks.push_back(
      at_least(where + "shortest time during which all walls were touched [s]", touched, 0.1));
  checks.push_back(at_most(where + "highest E_c [J]", energy, 5e-5));
  checks.push_back(at_most(where + "largest energy that friction gave in a tick [J]", given, 1e-7));
  checks.push_back(at_most(
      where + "part of the friction force outside the friction cone, divided by the normal force",
      beyond, 1e-6));
  return panel;
}

}  // namespace

Trial rubbing(const ArmDescription& arm, const std::string& name, const RoughWalls& walls,
              HandPath hand, const Parameters& p) {
  std::string text = "title = \"Rough walls\"\nabout = \"Planes with friction.\"\n";
  for (int i = 0; i < walls.walls; ++i) {
    const Vec3& n = kOutward[i];
    text += fmt::format(
        "\n[[plane]]\nname = \"wall {}\"\npoint = [{:.3f}, {:.3f}, {:.3f}]\n"
        "normal = [{:.1f}, {:.1f}, {:.1f}]\nstiffness = {:.1f}\n"
        "friction_static = {}\nfriction_kinetic = {}\n",
        i + 1, kMeet.x(), kMeet.y(), kMeet.z(), n.x(), n.y(), n.z(), walls.stiffness,
        walls.friction_static, walls.friction_kinetic);
  }
  return {name, plan_in(arm, text, std::move(hand), p)};
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

Outcome friction(TrialRunner& lab) {
  const std::vector<Dragged> all = drag_all(lab);
  const Verdict& rough = all.front().verdict;
  Outcome outcome;
  outcome.figure.title = "Friction: sticking, slipping, and the energy that friction takes";
  outcome.figure.caption = fmt::format(
      "Predictive coupling. A hand of 300 N/m and 2 N s/m presses a plane of {} N/m with {} N. "
      "Then the hand moves the tip {} mm sideways and back. In an edge and in a corner of walls "
      "the hand presses with {} N and moves around, in a grip of 300 N/m with eta = 0.3 (drawn) "
      "and in a grip of 3000 N/m with eta = 1. Each motion in edge and corner is made twice: with "
      "motors of {} N m, which never reach their limit, and with the arm's own motors, which reach "
      "their limit.",
      kWall, kPress, 1e3 * kDrag, kEdgePress, kStrong);
  outcome.figure.columns = 2;
  double given = 0;
  for (const Dragged& d : all) given = worse(given, d.verdict.given);
  outcome.checks = {
      at_least("plane: number of ticks in which the tip certainly stuck", rough.stuck, 100),
      at_least("plane: number of ticks in which the tip clearly slipped", rough.slid, 100),
      at_most("plane: largest motion of the stuck tip in a tick, minus the motion of the "
              "friction's spring [m]",
              rough.crept, 1e-9),
      at_least(
          "plane: highest ratio of tangential to normal force, divided by the static coefficient",
          rough.broke_away / kStatic, 0.99),
      at_most("plane: part of the friction force outside the static friction cone, divided by the "
              "normal force",
              rough.beyond, 1e-6),
      at_most("plane: relative deviation of the tangential force from the kinetic friction force "
              "while the tip slips",
              rough.off_kinetic, 0.01),
      at_most("plane: largest energy that friction gave in a tick [J]", given, 1e-7)};
  outcome.figure.panels = {
      ratio_panel(all), stick_panel(drag(lab.arm(), all[0].what.walls), all[0]), taken_panel(all)};
  outcome.figure.panels.push_back(
      between_walls(lab, kStrong, fmt::format("motors of {} N m", kStrong), outcome.checks));
  outcome.figure.panels.push_back(
      between_walls(lab, kFromArm, "the arm's own motors", outcome.checks));
  return outcome;
}

}  // namespace limpid
