// A body that falls on the tip: its energy in the ledger, and the force on the hand.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/moving.h"
#include "app/experiments/staggered.h"

namespace limpid {
namespace {

constexpr double kDropMass = 0.05, kDropHeight = 0.1, kDropEdge = 0.03;  // [kg, m, m]
constexpr double kDropTip = 0.004, kDropGravity = 9.81;                  // [m, m/s^2]
constexpr double kDropTick = 0.001, kDropSeconds = 0.6;                  // [s]
constexpr double kDropHard[] = {600, 2000, 5000};                        // [N/m]
constexpr double kDropUsual = 2000, kDropDamping = 2;                    // [N/m, N s/m]
const Vec3 kDropUnder(0.18, 0, 0);  // where the hand holds the tip [m]

std::string falling(double stiffness) {
  return scene_of({{.size = Vec3::Constant(kDropEdge),
                    .mass = kDropMass,
                    .at = kDropUnder + (kDropTip + kDropHeight + kDropEdge / 2) * Vec3::UnitZ(),
                    .stiffness = stiffness,
                    .friction = 0.5}},
                  fmt::format("gravity = [0, 0, {}]\ntip_radius = {}\n", -kDropGravity, kDropTip));
}

HandPath holding() {
  return hand_path("holds the tip", kDropTick, kDropSeconds, [](double) { return kDropUnder; });
}

Trial dropped(const ExperimentArm& on, CouplingKind kind, double stiffness) {
  Parameters p = on.settings;
  p.kind = kind;
  Trial trial{fmt::format("{}-{}", name(kind), stiffness),
              plan_in(on.description, falling(stiffness), holding(), p)};
  trial.may_diverge = kind != CouplingKind::predictive;
  return trial;
}

StaggeredRun drop_staggered(const ExperimentArm& on, double damping) {
  return run_staggered(on.description, on.settings, holding(),
                       {.mass = kDropMass,
                        .stiffness = kDropUsual,
                        .damping = damping,
                        .normal = Vec3(-Vec3::UnitZ()),
                        .gap = kDropHeight,
                        .own = [](double) { return kDropMass * kDropGravity; }});
}

FigurePanel drop_panel(const std::string& title, const std::string& y) {
  return {
      .title = title, .x_label = "time [s]", .y_label = y, .x_range = std::pair(0.0, kDropSeconds)};
}

Series of_run(const StaggeredRun& run, const std::string& label, const char* ink, double unit,
              const std::vector<double>& values) {
  Series line{label, ink, Series::Style::line, {}};
  for (std::size_t k = 0; k < values.size(); ++k) {
    line.points.push_back({static_cast<double>(k) * run.record.tick, unit * values[k]});
  }
  return line;
}

double force_on_tip(const Session& s, std::size_t k) {
  const auto force = s.at(k, Column::contact_force);
  return Vec3(force[0], force[1], force[2]).norm();
}

}  // namespace

Outcome drop(TrialRunner& lab) {
  using enum CouplingKind;
  const ExperimentArm& on = lab.arm();
  std::vector<Trial> trials;
  for (const double K : kDropHard) trials.push_back(dropped(on, predictive, K));
  for (const auto kind : {proposed, standard}) trials.push_back(dropped(on, kind, kDropUsual));
  const std::vector<TrialResult> results = lab.run(trials);

  FigurePanel height =
      drop_panel("Height of the block's lower face above the resting tip", "height [mm]");
  FigurePanel reserve = drop_panel("Reserve of the energy account, predictive", "reserve [mJ]");
  FigurePanel force =
      drop_panel(fmt::format("Force on the tip, K_o = {} N/m", kDropUsual), "force [N]");
  FigurePanel beyond = drop_panel(
      fmt::format("Energy to the human minus the block's energy, K_o = {} N/m", kDropUsual),
      "energy [mJ]");
  Outcome outcome;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const Session& s = results[i].session;
    const CouplingKind kind = trials[i].plan.parameters.kind;
    const bool ours = kind == predictive;
    const std::string label =
        ours ? fmt::format("{} N/m", kDropHard[i]) : fmt::format("{}", name(kind));
    const char* ink = ours ? kFamilyInk[i] : kind == proposed ? kProposedInk : kStandardInk;
    if (ours) {
      height.series.push_back(over_time(s, label, ink, Series::Style::line, [&](auto k) {
        return 1e3 * (s.at(k, Column::body_pose)[2] - kDropEdge / 2 - kDropTip - kDropUnder.z());
      }));
      reserve.series.push_back(over_time(s, label, ink, Series::Style::line, [&](auto k) {
        return 1e3 * s.at(k, Column::energy_ledger)[0];
      }));
    }
    if (ours && kDropHard[i] != kDropUsual) continue;
    const char* law = ours ? kPredictiveInk : ink;
    force.series.push_back(over_time(s, name(kind), law, Series::Style::line,
                                     [&](auto k) { return force_on_tip(s, k); }));
    beyond.series.push_back(over_time(s, name(kind), law, Series::Style::line,
                                      [&](auto k) { return 1e3 * beyond_at(s, k); }));
  }
  for (const auto& [damping, ink] : {std::pair(0.0, kDeviceInk), {kDropDamping, kContactInk}}) {
    const StaggeredRun run = drop_staggered(on, damping);
    const std::string label = fmt::format("staggered, {} N s/m", damping);
    force.series.push_back(of_run(run, label, ink, 1, run.contact));
    beyond.series.push_back(of_run(run, label, ink, 1e3, run.beyond));
  }
  height.y_range = {-100, 110};
  reserve.y_range = {0, 22};
  outcome.figure.title = "A block falls on the tip";
  outcome.figure.columns = 2;
  outcome.figure.panels = {height, reserve, force, beyond};
  outcome.figure.caption = fmt::format(
      "A block of {} g falls from {} cm above a tip. A hand holds the tip still. Friction is 0.5; "
      "contacts have {}, {} and {} N/m. The falling block has an energy of {:.0f} mJ. The energy "
      "account counts this energy as given by bodies, so the reserve does not fall. Staggered "
      "means no coupling: the force of a tick is computed from the last positions of tip and "
      "block. In the staggered case the block cannot slip off the tip.",
      1e3 * kDropMass, 100 * kDropHeight, kDropHard[0], kDropHard[1], kDropHard[2],
      1e3 * kDropMass * kDropGravity * kDropHeight);
  for (std::size_t i = 0; i < std::size(kDropHard); ++i) {
    const MovingVerdict v = judge_moving(results[i]);
    const std::string which = fmt::format("predictive, {} N/m: ", kDropHard[i]);
    double hardest = 0;
    for (std::size_t k = 0; k < results[i].session.size(); ++k) {
      hardest = worse(hardest, force_on_tip(results[i].session, k));
    }
    outcome.checks.push_back(at_least(which + "largest force on the tip [N]", hardest, 1));
    outcome.checks.push_back(
        at_least(which + "lowest reserve of the energy account, minus the reserve at the start [J]",
                 v.reserve, -1e-4));
    outcome.checks.push_back(at_least(
        which + "smallest share of the contact force that the governor allowed", v.governor, 1));
    outcome.checks.push_back(at_most(which + "highest E_c [J]", v.energy, 5e-4));
    outcome.checks.push_back(
        at_most(which + "largest energy given to the human minus the energy of the block [J]",
                v.beyond, 5e-5));
    outcome.checks.push_back(at_most(which + "energy gained by the block [J]", v.gain, 1e-6));
  }
  return outcome;
}

}  // namespace limpid
