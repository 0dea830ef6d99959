// How light each coupling makes the arm: inertia and damping felt in free motion, what a passive
// law has to pay for it, and eta changing while the arm moves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/experiments/felt_impedance.h"
#include "app/experiments/roaming.h"
#include "app/experiments/series.h"

namespace limpid {
namespace {

constexpr double kLightEtas[] = {0.2, 0.3, 0.5, 1, 2, 5};
constexpr double kLightGrip = 300, kLightGripDamping = 4;  // [N/m], [N s/m]
constexpr double kSettle = 2, kPeriod = 2, kTick = 0.001;  // [s]
constexpr double kAmplitude = 2.5e-4;                      // at 1 Hz [m]

Multisine shaking() {
  constexpr std::pair<int, double> kLines[] = {{1, 0},    {2, 1.1},  {4, 2.3}, {6, 0.7},
                                               {10, 4.0}, {14, 1.9}, {20, 5.2}};
  Multisine signal{1 / kPeriod, {}};
  for (const auto& [multiple, phase] : kLines) {
    signal.lines.push_back({multiple, kAmplitude * kPeriod / multiple, phase});
  }
  return signal;
}

struct Law {
  CouplingKind kind;
  double eta;
  std::vector<FeltMotion> felt = {};
  bool stable = true;

  const FeltMotion& at(double f) const {
    return *std::ranges::min_element(felt, {},
                                     [f](const FeltMotion& m) { return std::abs(m.f - f); });
  }
  std::string label() const {
    return kind == CouplingKind::standard ? "standard" : fmt::format("eta = {}", eta);
  }
};

// The standard coupling, then both others at each eta.
std::vector<Law> all_laws() {
  std::vector<Law> laws{{CouplingKind::standard, 1}};
  for (const CouplingKind kind : {CouplingKind::proposed, CouplingKind::predictive}) {
    for (const double eta : kLightEtas) laws.push_back({kind, eta});
  }
  return laws;
}

Trial shaken(const Law& law) {
  Parameters p;
  p.kind = law.kind;
  p.eta = law.eta;
  p.hand_stiffness = kLightGrip;
  p.hand_damping = kLightGripDamping;
  const Vec3 along = Vec3(1, 0.8, 0.6).normalized();
  const auto at = [signal = shaking(), along](double t) {
    return Vec3(kHome + minimum_jerk(t / 0.5) * signal.at(t) * along);
  };
  const std::string source = fmt::format("shaking at 7 frequencies, {} m at 1 Hz", kAmplitude);
  return {fmt::format("{}-eta-{}", name(p.kind), p.eta),
          plan_in(kFreeSpace, hand_path(source, kTick, kSettle + kPeriod + kTick, at), p)};
}

std::vector<Law> shake(Laboratory& lab) {
  std::vector<Law> laws = all_laws();
  std::vector<Trial> trials;
  trials.reserve(laws.size());
  for (const Law& law : laws) trials.push_back(shaken(law));
  const RunPlan& plan = trials.front().plan;
  const Eigen::MatrixXd M =
      (1 + plan.parameters.inertia_ratio) * inertia_at(plan.arm, rest_at(plan.arm, kHome).x1);
  const auto settled = static_cast<std::size_t>(std::llround(kSettle / kTick));
  const std::vector<TrialResult> results = lab.run(trials);
  for (std::size_t i = 0; i < laws.size(); ++i) {
    laws[i].stable = !results[i].end.diverged;
    if (laws[i].stable) laws[i].felt = measured_motion(results[i].session, settled, M, shaking());
  }
  return laws;
}

std::vector<Law> of(const std::vector<Law>& laws, CouplingKind kind) {
  std::vector<Law> some;
  std::ranges::copy_if(laws, std::back_inserter(some),
                       [kind](const Law& law) { return law.kind == kind && law.stable; });
  return some;
}

// What an inertia of eta up to 5.3 Hz costs any passive law in damping felt at low frequency.
double least_damping(double eta, double mass) {
  return std::max(0.0, 1 - eta) * mass * 2 * std::numbers::pi * Parameters{}.band;
}

FigurePanel over_frequency(const std::vector<Law>& laws, const std::string& title,
                           const std::string& y, double FeltMotion::*value) {
  FigurePanel panel{.title = title, .x_label = "frequency [Hz]", .y_label = y, .log_x = true};
  panel.x_range = {0.45, 11};
  std::size_t ink = 0;
  for (const Law& law : laws) {
    const bool standard = law.kind == CouplingKind::standard;
    const char* color = standard ? kStandardInk : kFamilyInk[ink++];
    Series line{law.label(), color, Series::Style::line, {}}, dots = line, wanted = line;
    for (const FeltMotion& m : law.felt) line.points.push_back({m.f, m.*value});
    dots = {"", color, Series::Style::points, line.points};
    panel.series.push_back(line);
    panel.series.push_back(dots);
    if (value != &FeltMotion::inertia || standard) continue;
    wanted = {"", color, Series::Style::dashed, {{0.45, law.eta}, {5.3, law.eta}}};
    panel.series.push_back(wanted);
  }
  return panel;
}

// At one frequency, of all laws, against eta.
FigurePanel against_eta(const std::vector<Law>& laws, double f, const std::string& title,
                        const std::string& y, double FeltMotion::*value) {
  FigurePanel panel{.title = title, .x_label = "eta [-]", .y_label = y, .log_x = true};
  panel.x_range = {0.1, 10};
  const auto add = [&](CouplingKind kind, const char* ink) {
    Series line{name(kind), ink, Series::Style::line, {}};
    for (const Law& law : of(laws, kind)) line.points.push_back({law.eta, law.at(f).*value});
    if (line.points.size() == 1) {
      line.style = Series::Style::dashed;
      line.points = {{0.1, line.points[0].y}, {10, line.points[0].y}};
      panel.series.push_back(line);
      return;
    }
    panel.series.push_back(line);
    panel.series.push_back({"", ink, Series::Style::points, line.points});
  };
  add(CouplingKind::standard, kStandardInk);
  add(CouplingKind::proposed, kProposedInk);
  add(CouplingKind::predictive, kPredictiveInk);
  return panel;
}

FigurePanel price_panel(const std::vector<Law>& laws) {
  constexpr double kAt = 0.5;
  FigurePanel panel{.title = "What lightness costs: damping at 0.5 Hz against inertia at 2 Hz",
                    .x_label = "inertia felt, of the arm's own [-]",
                    .y_label = "damping felt [N m s/rad]"};
  panel.x_range = {0, 1.1};
  panel.y_range = {0, 0.03};
  const double mass = of(laws, CouplingKind::predictive).front().at(kAt).mass;
  panel.series.push_back({"least of any passive law that keeps it up to 5.3 Hz",
                          kNeutralInk,
                          Series::Style::dashed,
                          {{0, least_damping(0, mass)}, {1, 0}}});
  for (const auto& [kind, ink] : {std::pair(CouplingKind::proposed, kProposedInk),
                                  {CouplingKind::predictive, kPredictiveInk}}) {
    Series line{
        fmt::format("{}, eta {} to 1", name(kind), kLightEtas[0]), ink, Series::Style::line, {}};
    for (const Law& law : of(laws, kind)) {
      if (law.eta <= 1) line.points.push_back({law.at(2).inertia, law.at(kAt).damping});
    }
    panel.series.push_back(line);
    panel.series.push_back({"", ink, Series::Style::points, line.points});
  }
  return panel;
}

std::vector<FigurePanel> panels(const std::vector<Law>& laws) {
  constexpr const char *kInertia = "inertia, of the arm's own [-]",
                       *kDamping = "damping [N m s/rad]";
  const std::vector<Law> ours = of(laws, CouplingKind::predictive);
  std::vector<Law> papers = of(laws, CouplingKind::proposed);
  papers.push_back(laws.front());
  FigurePanel inertia = over_frequency(ours, "Predictive: inertia felt (dashed: eta)", kInertia,
                                       &FeltMotion::inertia);
  inertia.log_y = true;
  inertia.y_range = {0.1, 10};
  FigurePanel damping =
      over_frequency(ours, "Predictive: damping felt", kDamping, &FeltMotion::damping);
  damping.y_range = {0, 0.06};
  FigurePanel before = over_frequency(papers, "Proposed and standard: inertia felt (dashed: eta)",
                                      kInertia, &FeltMotion::inertia);
  before.y_range = {-3, 6};
  FigurePanel drag =
      over_frequency(papers, "Proposed and standard: damping felt", kDamping, &FeltMotion::damping);
  drag.y_range = {0, 0.06};
  FigurePanel scaled = against_eta(laws, 2, "Inertia felt at 2 Hz", kInertia, &FeltMotion::inertia);
  scaled.y_range = {-3, 6};
  scaled.series.insert(scaled.series.begin(), {"eta", kHandInk, Series::Style::dashed, {}});
  FigurePanel damped =
      against_eta(laws, 0.5, "Damping felt at 0.5 Hz", kDamping, &FeltMotion::damping);
  damped.y_range = {0, 0.06};
  Series least{"least of any passive law with that inertia", kHandInk, Series::Style::dashed, {}};
  const double mass = ours.front().at(0.5).mass;
  for (double eta = 0.1; eta < 10; eta *= 1.05) {
    scaled.series.front().points.push_back({eta, eta});
    if (eta < 1) least.points.push_back({eta, least_damping(eta, mass)});
  }
  damped.series.insert(damped.series.begin(), least);
  return {inertia, damping, before, drag, scaled, damped, price_panel(laws)};
}

}  // namespace

Outcome lightness(Laboratory& lab) {
  const std::vector<Law> laws = shake(lab);
  Outcome outcome;
  outcome.figure.title = "How light the arm can be made";
  outcome.figure.caption = fmt::format(
      "Free motion, the tip shaken at seven frequencies at once, {} mm at 1 Hz and less above, in "
      "a grip of {} N/m and {} N s/m; exact encoders. Inertia and damping: the hand's torque "
      "against and along the motion of all joints. An inertia of eta up to {} Hz costs every "
      "passive law a damping of at least 1 - eta times the inertia times that frequency in rad/s. "
      "The proposed coupling's inertia at eta = 5 lies below the frames. Last: the arm roams in an "
      "undamped grip of 3000 N/m.",
      1e3 * kAmplitude, kLightGrip, kLightGripDamping, Parameters{}.band);
  outcome.figure.columns = 2;
  outcome.figure.panels = panels(laws);
  for (const Law& law : of(laws, CouplingKind::predictive)) {
    if (law.eta == 1) continue;
    double off = 0;
    for (const FeltMotion& m : law.felt) {
      if (m.f <= 5) off = std::max(off, std::abs(m.inertia / law.eta - 1));
    }
    outcome.checks.push_back(at_most(
        fmt::format("predictive, eta = {}: inertia felt off eta, 0.5 to 5 Hz, of it", law.eta), off,
        0.1));
  }
  for (const Law& law : of(laws, CouplingKind::predictive)) {
    if (law.eta >= 1) continue;
    const FeltMotion& m = law.at(0.5);
    outcome.checks.push_back(
        at_least(fmt::format("predictive, eta = {}: damping felt at 0.5 Hz over the least of any "
                             "passive law",
                             law.eta),
                 m.damping / least_damping(law.eta, m.mass), 1));
  }
  roam(lab, outcome);
  return outcome;
}

}  // namespace limpid
