#include "app/experiments/felt_impedance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/experiments/signals.h"
#include "core/math/elementary.h"

namespace limpid {

namespace {

double omega(double f) { return 2 * std::numbers::pi * f; }

// A joint's human torque and velocity, both means over the same tick.
class Shaken {
 public:
  Shaken(const Session& session, std::size_t from, int joint) : T_(session.info.tick) {
    const auto j = static_cast<std::size_t>(joint);
    for (std::size_t k = from; k + 1 < session.size(); ++k) {
      torque_.push_back(session.at(k, Column::hand_torque)[j]);
      velocity_.push_back((session.at(k + 1, Column::device_position)[j] -
                           session.at(k, Column::device_position)[j]) /
                          T_);
    }
  }
  std::complex<double> torque_at(double f) const { return amplitude_at(torque_, T_, f); }
  std::complex<double> velocity_at(double f) const { return amplitude_at(velocity_, T_, f); }

 private:
  double T_;
  std::vector<double> torque_, velocity_;
};

constexpr double kRoamingGrip = 3000;                   // [N/m]
constexpr double kRoamingTick = 0.001, kRoaming = 2.5;  // [s]
constexpr double kRoamingLowest = 0.1;                  // eta

// eta over time, for an arm that roams in a stiff undamped grip.
struct Wobble {
  std::string label;
  double frequency;  // of a square wave [Hz]; 0: a sine of 0.8 Hz
  CouplingKind kind = CouplingKind::predictive;

  double eta(double t) const {
    if (frequency > 0) return std::fmod(t * frequency, 1) < 0.5 ? kRoamingLowest : 1;
    return kRoamingLowest + (1 - kRoamingLowest) / 2 * (1 + sine(5 * t));
  }
};

Trial roaming(const ExperimentArm& on, const Wobble& wobble) {
  Parameters p = on.settings;
  p.kind = wobble.kind;
  p.eta = wobble.eta(0);
  p.hand_stiffness = kRoamingGrip;
  p.hand_damping = 0;
  p.torque_limit = 100;
  const auto at = [](double t) {
    return Vec3(kHome + 0.02 * Vec3(sine(9 * t), sine(7 * t), sine(8 * t)));
  };
  Trial trial{
      "", plan_in(on.description, kFreeSpace, hand_path("roaming", kRoamingTick, kRoaming, at), p)};
  trial.keep = false;
  trial.may_diverge = wobble.kind == CouplingKind::proposed;  // diverging is checked
  double before = p.eta;
  for (std::uint64_t k = 1; k < trial.plan.rows; ++k) {
    const double eta = wobble.eta(static_cast<double>(k) * kRoamingTick);
    if (eta == before) continue;
    trial.plan.changes.push_back({k, fmt::format("coupling.eta = {:.6f}", eta)});
    before = eta;
  }
  return trial;
}

double highest_energy(const TrialResult& result) {
  double most = 0;
  for (std::size_t k = 0; k < result.session.size(); ++k) {
    most = worse(most, result.session.at(k, Column::energy_total)[0]);
  }
  return result.end.diverged ? std::numeric_limits<double>::infinity() : most;
}

}  // namespace

Impedance measured_impedance(const Session& session, std::size_t from, int joint,
                             const Multisine& shaking) {
  const Shaken shaken(session, from, joint);
  Impedance felt;
  for (const Multisine::Line& line : shaking.lines) {
    const double f = shaking.frequency(line);
    felt.f.push_back(f);
    felt.Z.push_back(shaken.torque_at(f) / shaken.velocity_at(f));
  }
  return felt;
}

std::vector<FeltMotion> measured_motion(const Session& session, std::size_t from,
                                        const Eigen::MatrixXd& M, const Multisine& shaking) {
  std::vector<Shaken> joints;
  for (int j = 0; j < session.info.dof; ++j) joints.emplace_back(session, from, j);
  std::vector<FeltMotion> felt;
  for (const Multisine::Line& line : shaking.lines) {
    const double f = shaking.frequency(line);
    Eigen::VectorXcd torque(M.rows()), velocity(M.rows());
    for (Eigen::Index j = 0; j < M.rows(); ++j) {
      torque[j] = joints[static_cast<std::size_t>(j)].torque_at(f);
      velocity[j] = joints[static_cast<std::size_t>(j)].velocity_at(f);
    }
    const std::complex<double> power = velocity.dot(torque);
    const double moving = velocity.dot(M * velocity).real(), speed2 = velocity.squaredNorm();
    felt.push_back({f, power.imag() / (omega(f) * moving), power.real() / speed2, moving / speed2});
  }
  return felt;
}

double apparent_inertia(const Impedance& felt, double highest) {
  double ww = 0, wz = 0;
  for (std::size_t i = 0; i < felt.f.size(); ++i) {
    if (felt.f[i] > highest) continue;
    const double w = omega(felt.f[i]);
    ww += w * w;
    wz += w * felt.Z[i].imag();
  }
  return wz / ww;
}

void roam(TrialRunner& lab, Outcome& outcome) {
  const std::vector<Wobble> wobbles{{"proposed, sine", 0, CouplingKind::proposed},
                                    {"predictive, sine of 0.8 Hz", 0},
                                    {"square wave, 3 Hz", 3},
                                    {"20 Hz", 20},
                                    {"37 Hz", 37}};
  std::vector<Trial> trials;
  for (const Wobble& w : wobbles) trials.push_back(roaming(lab.arm(), w));
  const std::vector<TrialResult> results = lab.run(trials);
  FigurePanel panel{.title = "Energy while eta changes between 0.1 and 1",
                    .x_label = "time [s]",
                    .y_label = "E_c [mJ]"};
  panel.x_range = {0, kRoaming};
  double worst = 0, lowest = 0;
  for (std::size_t i = 0; i < wobbles.size(); ++i) {
    const Session& s = results[i].session;
    const char* ink = i == 0 ? kContactInk : kFamilyInk[std::array{0, 0, 1, 2, 4}[i]];
    panel.series.push_back(over_time(s, wobbles[i].label, ink, Series::Style::line, [&](auto k) {
      return 1e3 * s.at(k, Column::energy_total)[0];
    }));
    if (i == 0) continue;
    worst = worse(worst, highest_energy(results[i]));
    lowest = std::min(lowest, panel.series.back().points.back().y);
  }
  panel.y_range = {1.05 * lowest, -0.3 * lowest};
  outcome.figure.panels.push_back(panel);
  outcome.checks.push_back(
      at_least("proposed: highest E_c while eta follows a sine, lower limit [J]",
               highest_energy(results.front()), 0.1));
  outcome.checks.push_back(
      at_most("predictive: highest E_c in free motion while eta changes between 0.1 and 1 [J]",
              worst, 1e-6));
}

}  // namespace limpid
