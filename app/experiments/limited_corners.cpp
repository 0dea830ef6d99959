#include "app/experiments/limited_corners.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/assets.h"
#include "app/experiments/excitation.h"
#include "app/experiments/series.h"
#include "devices/files/arm/urdf_file.h"
#include "devices/rig/random_corner.h"

namespace limpid {
namespace {

// What the corners are drawn from, and what is promised of them. The tests of the rig run some
// hundreds of both; these are the first of them.
struct CornerSet {
  const char* label;
  const char* ink;
  CornerWidth width;
  unsigned first, count;  // seeds
  double most_torque;     // of the contacts, by the motors' limit [-]
};
constexpr CornerSet kCornerSets[] = {
    {"built-in arm", kPredictiveInk, {}, 0, 120, 1.3},
    {"other arms, more walls, any eta", kDeviceInk, kWideCorners, 1000, 48, 1.6}};
constexpr double kMostEnergy = 5e-5, kMostJump = 0.01;  // [J], [rad]

Trial corner_trial(const LimitedCorner& corner, unsigned seed) {
  Trial trial{"", {}};
  trial.keep = false;
  RunPlan& plan = trial.plan;
  plan.arm = corner.arm;
  plan.document.scene = corner.scene;
  plan.hand = hand_path(fmt::format("into the corner {}", seed), corner.p.tick,
                        LimitedCorner::kLasts, [&](double t) { return corner.hand(t); });
  plan.parameters = corner.p;
  plan.start = corner.start;
  plan.rows = plan.hand.time.size();
  return trial;
}

// Of a run, or the worst of many.
struct Cornered {
  double energy = 0;          // highest E_c [J]
  double port = 0;            // most that the hand was given [J]
  double torque = 0;          // largest of the contacts on a joint, by the motor's limit [-]
  double jump = 0;            // farthest that the proxy's joints go in a tick [rad]
  double reserve = HUGE_VAL;  // least [J]
  bool at_limit = false;      // a motor was

  void add(const Cornered& other) {
    energy = worse(energy, other.energy);
    port = worse(port, other.port);
    torque = worse(torque, other.torque);
    jump = worse(jump, other.jump);
    reserve = worse_low(reserve, other.reserve);
  }
};

Cornered cornered(const Session& s, double limit) {
  Cornered c;
  for (std::size_t k = 0; k < s.size(); ++k) {
    c.energy = worse(c.energy, s.at(k, Column::energy_total)[0]);
    c.port = worse(c.port, s.at(k, Column::energy_port)[0]);
    c.reserve = worse_low(c.reserve, s.at(k, Column::energy_ledger)[0]);
    c.torque =
        worse(c.torque, vector_at(s, k, Column::contact_torque).cwiseAbs().maxCoeff() / limit);
    c.at_limit = c.at_limit || vector_at(s, k, Column::motor_torque).cwiseAbs().maxCoeff() >= limit;
    if (k == 0) continue;
    const Eigen::VectorXd moved =
        vector_at(s, k, Column::proxy_position) - vector_at(s, k - 1, Column::proxy_position);
    c.jump = worse(c.jump, moved.cwiseAbs().maxCoeff());
  }
  return c;
}

void judge(const CornerSet& set, const Cornered& worst, int at_limit, std::vector<Check>& checks) {
  const std::string where = fmt::format("{} corners, {}: ", set.count, set.label);
  checks.push_back(at_least(where + "in how many a motor met its limit", at_limit, set.count / 3));
  checks.push_back(at_most(where + "highest E_c [J]", worst.energy, kMostEnergy));
  checks.push_back(at_most(where + "given to the human [J]", worst.port, kMostEnergy));
  checks.push_back(at_most(where + "largest contact torque over the motors' limit", worst.torque,
                           set.most_torque));
  checks.push_back(
      at_most(where + "farthest that the proxy goes in a tick [rad]", worst.jump, kMostJump));
  checks.push_back(at_least(where + "least reserve [J]", worst.reserve, 0));
}

}  // namespace

void press_into_corners(Laboratory& lab, Outcome& outcome) {
  const ArmDescription desktop = read_urdf(default_device());
  FigurePanel torque{.title = "Pressed into random corners: contact torque",
                     .x_label = "limit of every motor [N m]",
                     .y_label = "largest contact torque, by the limit [-]"};
  FigurePanel jump{.title = "Pressed into random corners: the proxy's steps",
                   .x_label = "limit of every motor [N m]",
                   .y_label = "farthest in a tick [mrad]"};
  torque.x_range = jump.x_range = {0.08, 0.62};
  torque.y_range = {0, 2};
  jump.y_range = {0, 14};
  for (const CornerSet& set : kCornerSets) {
    std::vector<LimitedCorner> corners;
    std::vector<Trial> trials;
    for (unsigned i = 0; i < set.count; ++i) {
      corners.push_back(limited_corner(set.first + i, set.width, desktop));
      trials.push_back(corner_trial(corners.back(), set.first + i));
    }
    std::vector<Cornered> found(trials.size());
    lab.run(trials, [&](std::size_t i, const TrialResult& r) {
      found[i] = cornered(r.session, corners[i].limit);
    });
    Series torques{set.label, set.ink, Series::Style::points, {}}, jumps = torques;
    Cornered worst;
    int at_limit = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      worst.add(found[i]);
      at_limit += found[i].at_limit;
      torques.points.push_back({corners[i].limit, found[i].torque});
      jumps.points.push_back({corners[i].limit, 1e3 * found[i].jump});
    }
    torque.series.push_back(torques);
    torque.series.push_back({fmt::format("bound, {}", set.label),
                             set.ink,
                             Series::Style::dashed,
                             {{0.08, set.most_torque}, {0.62, set.most_torque}}});
    jump.series.push_back(jumps);
    judge(set, worst, at_limit, outcome.checks);
  }
  jump.series.push_back({"bound",
                         kNeutralInk,
                         Series::Style::dashed,
                         {{0.08, 1e3 * kMostJump}, {0.62, 1e3 * kMostJump}}});
  outcome.figure.panels.push_back(torque);
  outcome.figure.panels.push_back(jump);
}

}  // namespace limpid
