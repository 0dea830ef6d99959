// Lightness of the arm under each coupling: inertia and damping felt in free motion, the price of
// it for a passive law, and eta changing while the arm moves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/experiments/felt_impedance.h"
#include "app/experiments/signals.h"

namespace limpid {
namespace {

constexpr double kLightEtas[] = {0.2, 0.3, 0.5, 1, 2, 5};
constexpr double kLightGrip = 300, kLightGripDamping = 4;              // [N/m], [N s/m]
constexpr double kSettle = 2, kShakenPeriod = 2, kShakenTick = 0.001;  // [s]
constexpr double kAmplitude = 2.5e-4;                                  // at 1 Hz [m]
constexpr double kSlow = 0.5, kMiddle = 2;  // frequencies at which laws are compared [Hz]

Multisine shaking() {
  constexpr std::pair<int, double> kLines[] = {{1, 0},    {2, 1.1},  {4, 2.3}, {6, 0.7},
                                               {10, 4.0}, {14, 1.9}, {20, 5.2}};
  Multisine signal{1 / kShakenPeriod, {}};
  for (const auto& [multiple, phase] : kLines) {
    signal.lines.push_back({multiple, kAmplitude * kShakenPeriod / multiple, phase});
  }
  return signal;
}

struct LawAtEta {
  CouplingKind kind;
  double eta;
  std::vector<FeltMotion> felt = {};  // empty if it diverged

  // NaN if it diverged, so that its checks fail.
  FeltMotion at(double f) const {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (felt.empty()) return {f, kNone, kNone, kNone};
    return *std::ranges::min_element(felt, {},
                                     [f](const FeltMotion& m) { return std::abs(m.f - f); });
  }
  // |Z|, torque over speed [N m s/rad].
  double impedance(double f) const {
    const FeltMotion m = at(f);
    return std::hypot(m.damping, 2 * std::numbers::pi * m.f * m.inertia * m.mass);
  }
  std::string label() const {
    // The proposed coupling at eta = 1 has the same curve, hidden under this one.
    return kind == CouplingKind::standard ? "standard (hides eta = 1)"
                                          : fmt::format("eta = {}", eta);
  }
};

// The standard coupling, then both others at each eta.
std::vector<LawAtEta> all_laws() {
  std::vector<LawAtEta> laws{{CouplingKind::standard, 1}};
  for (const CouplingKind kind : {CouplingKind::proposed, CouplingKind::predictive}) {
    for (const double eta : kLightEtas) laws.push_back({kind, eta});
  }
  return laws;
}

Trial shaken(const ExperimentArm& on, const LawAtEta& law) {
  Parameters p = on.settings;
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
          plan_in(on.description, kFreeSpace,
                  hand_path(source, kShakenTick, kSettle + kShakenPeriod + kShakenTick, at), p)};
}

std::vector<LawAtEta> shake(TrialRunner& lab) {
  std::vector<LawAtEta> laws = all_laws();
  std::vector<Trial> trials;
  trials.reserve(laws.size());
  for (const LawAtEta& law : laws) trials.push_back(shaken(lab.arm(), law));
  const RunPlan& plan = trials.front().plan;
  const Eigen::MatrixXd M =
      (1 + plan.parameters.inertia_ratio) * inertia_at(plan.arm, rest_at(plan.arm, kHome).x1);
  const auto settled = static_cast<std::size_t>(std::llround(kSettle / kShakenTick));
  const std::vector<TrialResult> results = lab.run(trials);
  for (std::size_t i = 0; i < laws.size(); ++i) {
    if (results[i].end.diverged) continue;
    laws[i].felt = measured_motion(results[i].session, settled, M, shaking());
  }
  return laws;
}

std::vector<LawAtEta> of(const std::vector<LawAtEta>& laws, CouplingKind kind) {
  std::vector<LawAtEta> some;
  std::ranges::copy_if(laws, std::back_inserter(some),
                       [kind](const LawAtEta& law) { return law.kind == kind; });
  return some;
}

// Least damping felt at low frequency under any passive law with inertia eta up to 5.3 Hz.
double least_damping(double eta, double mass) {
  return std::max(0.0, 1 - eta) * mass * 2 * std::numbers::pi * Parameters{}.band;
}

FigurePanel over_frequency(const std::vector<LawAtEta>& laws, const std::string& title,
                           const std::string& y, double FeltMotion::*value) {
  FigurePanel panel{.title = title, .x_label = "frequency [Hz]", .y_label = y, .log_x = true};
  panel.x_range = {0.45, 11};
  for (const LawAtEta& law : laws) {
    const bool standard = law.kind == CouplingKind::standard;
    const auto ink = std::ranges::find(kLightEtas, law.eta) - std::begin(kLightEtas);
    const char* color = standard ? kStandardInk : kFamilyInk[ink];
    Series line{law.label(), color, Series::Style::line, {}};
    for (const FeltMotion& m : law.felt) line.points.push_back({m.f, m.*value});
    if (value == &FeltMotion::inertia && !standard) {
      panel.series.push_back(
          {"", color, Series::Style::dashed, {{0.45, law.eta}, {Parameters{}.band, law.eta}}});
    }
    panel.series.push_back(line);
    panel.series.push_back({"", color, Series::Style::points, line.points});
  }
  return panel;
}

// A curve over eta for each law.
template <class Value>
FigurePanel against_eta(const std::vector<LawAtEta>& laws, const std::string& title,
                        const std::string& y, const Value& value) {
  FigurePanel panel{.title = title, .x_label = "eta [-]", .y_label = y, .log_x = true};
  panel.x_range = {0.1, 10};
  const auto add = [&](CouplingKind kind, const char* ink) {
    Series line{name(kind), ink, Series::Style::line, {}};
    for (const LawAtEta& law : of(laws, kind)) {
      if (!law.felt.empty()) line.points.push_back({law.eta, value(law)});
    }
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

// The line y = eta, beside the felt values.
Series eta_itself() {
  Series line{"eta", kHandInk, Series::Style::dashed, {}};
  for (double eta = 0.1; eta < 10; eta *= 1.05) line.points.push_back({eta, eta});
  return line;
}

FigurePanel price_panel(const std::vector<LawAtEta>& laws) {
  FigurePanel panel{.title = "Cost of a light device: damping at 0.5 Hz against inertia at 2 Hz",
                    .x_label = "inertia felt / arm's own inertia [-]",
                    .y_label = "damping felt [N m s/rad]"};
  panel.x_range = {0, 1.1};
  panel.y_range = {0, 0.03};
  const double mass = of(laws, CouplingKind::predictive).front().at(kSlow).mass;
  panel.series.push_back(
      {"smallest damping of any passive law that keeps this inertia up to 5.3 Hz",
       kNeutralInk,
       Series::Style::dashed,
       {{0, least_damping(0, mass)}, {1, 0}}});
  for (const auto& [kind, ink] : {std::pair(CouplingKind::proposed, kProposedInk),
                                  {CouplingKind::predictive, kPredictiveInk}}) {
    Series line{
        fmt::format("{}, eta {} to 1", name(kind), kLightEtas[0]), ink, Series::Style::line, {}};
    for (const LawAtEta& law : of(laws, kind)) {
      if (law.eta > 1 || law.felt.empty()) continue;
      line.points.push_back({law.at(kMiddle).inertia, law.at(kSlow).damping});
    }
    panel.series.push_back(line);
    panel.series.push_back({"", ink, Series::Style::points, line.points});
  }
  return panel;
}

constexpr const char *kInertia = "inertia / arm's own inertia [-]",
                     *kDamping = "damping [N m s/rad]";

// Panels of the proposed coupling, lighter and heavier apart: their sizes differ.
std::vector<FigurePanel> proposed_panels(const std::vector<LawAtEta>& laws) {
  std::vector<LawAtEta> papers = of(laws, CouplingKind::proposed), light, heavy;
  for (const LawAtEta& law : papers) (law.eta <= 1 ? light : heavy).push_back(law);
  light.push_back(laws.front());
  papers.push_back(laws.front());
  FigurePanel lighter =
      over_frequency(light, "Proposed with eta up to 1, and standard: inertia felt (dashed: eta)",
                     kInertia, &FeltMotion::inertia);
  lighter.y_range = {0, 1.1};
  FigurePanel heavier =
      over_frequency(heavy, "Proposed with eta above 1: inertia felt (dashed: eta)", kInertia,
                     &FeltMotion::inertia);
  heavier.y_range = {-18, 6};
  FigurePanel drag =
      over_frequency(papers, "Proposed and standard: damping felt", kDamping, &FeltMotion::damping);
  drag.log_y = true;
  drag.y_range = {0.003, 0.3};
  FigurePanel slow = against_eta(laws, "Torque divided by speed at 0.5 Hz, relative to eta = 1",
                                 "|Z(eta)| / |Z(1)| [-]", [&](const LawAtEta& law) {
                                   const auto own = of(laws, law.kind);
                                   const auto one = std::ranges::find(own, 1.0, &LawAtEta::eta);
                                   return law.impedance(kSlow) / one->impedance(kSlow);
                                 });
  slow.log_y = true;
  slow.y_range = {0.1, 10};
  slow.series.insert(slow.series.begin(), eta_itself());
  return {lighter, heavier, drag, slow};
}

std::vector<FigurePanel> panels(const std::vector<LawAtEta>& laws) {
  const std::vector<LawAtEta> ours = of(laws, CouplingKind::predictive);
  FigurePanel inertia = over_frequency(ours, "Predictive: inertia felt (dashed: eta)", kInertia,
                                       &FeltMotion::inertia);
  inertia.log_y = true;
  inertia.y_range = {0.1, 10};
  FigurePanel damping =
      over_frequency(ours, "Predictive: damping felt", kDamping, &FeltMotion::damping);
  damping.y_range = {0, 0.06};
  FigurePanel scaled = against_eta(laws, "Inertia felt at 2 Hz", kInertia,
                                   [](const LawAtEta& law) { return law.at(kMiddle).inertia; });
  scaled.y_range = {-12, 6};
  scaled.series.insert(scaled.series.begin(), eta_itself());
  FigurePanel damped = against_eta(laws, "Damping felt at 0.5 Hz", kDamping,
                                   [](const LawAtEta& law) { return law.at(kSlow).damping; });
  damped.log_y = true;
  damped.y_range = {0.0005, 0.3};
  Series least{
      "smallest damping of any passive law with this inertia", kHandInk, Series::Style::dashed, {}};
  const double mass = ours.front().at(kSlow).mass;
  for (double eta = 0.1; eta < 1; eta *= 1.05) {
    least.points.push_back({eta, least_damping(eta, mass)});
  }
  damped.series.insert(damped.series.begin(), least);
  std::vector<FigurePanel> all{inertia, damping};
  for (FigurePanel& panel : proposed_panels(laws)) all.push_back(std::move(panel));
  all.insert(all.end(), {scaled, damped, price_panel(laws)});
  return all;
}

void judge_predictive(const std::vector<LawAtEta>& laws, std::vector<Check>& checks) {
  for (const LawAtEta& law : laws) {
    if (law.eta == 1) continue;
    double off = std::abs(law.at(kSlow).inertia / law.eta - 1);
    for (const FeltMotion& m : law.felt) {
      if (m.f <= 5) off = worse(off, std::abs(m.inertia / law.eta - 1));
    }
    checks.push_back(at_most(
        fmt::format(
            "predictive, eta = {}: relative deviation of the inertia felt from eta, 0.5 to 5 Hz",
            law.eta),
        off, 0.1));
  }
  for (const LawAtEta& law : laws) {
    if (law.eta >= 1) continue;
    const FeltMotion m = law.at(kSlow);
    checks.push_back(at_least(fmt::format("predictive, eta = {}: damping felt at 0.5 Hz, divided "
                                          "by the smallest damping that a passive law can have",
                                          law.eta),
                              m.damping / least_damping(law.eta, m.mass), 1));
  }
}

// Under the proposed coupling damping scales with eta; inertia does not.
void judge_proposed(const std::vector<LawAtEta>& laws, std::vector<Check>& checks) {
  const auto one = std::ranges::find(laws, 1.0, &LawAtEta::eta);
  for (const LawAtEta& law : laws) {
    if (law.eta == 1) continue;
    const double damping = law.at(kSlow).damping / one->at(kSlow).damping;
    checks.push_back(at_most(fmt::format("proposed, eta = {}: damping felt at 0.5 Hz, divided by "
                                         "the damping at eta = 1: relative deviation from eta",
                                         law.eta),
                             std::abs(damping / law.eta - 1), 0.05));
  }
  for (const LawAtEta& law : laws) {
    if (law.eta <= 1) continue;
    checks.push_back(at_most(fmt::format("proposed, eta = {}: inertia felt at 0.5 Hz, divided by "
                                         "the arm's own inertia (not equal to eta)",
                                         law.eta),
                             law.at(kSlow).inertia, 0));
  }
}

}  // namespace

Outcome lightness(TrialRunner& lab) {
  const std::vector<LawAtEta> laws = shake(lab);
  Outcome outcome;
  outcome.figure.title = "How light the arm can be made";
  outcome.figure.caption = fmt::format(
      "Free motion; the tip is shaken at seven frequencies at the same time, {} mm at 1 Hz and "
      "less at higher frequencies, in a grip of {} N/m and {} N s/m{}. Inertia and damping: the "
      "parts of the hand's torque that are proportional to the acceleration and to the velocity of "
      "all joints. To make the inertia felt eta times as large up to {} Hz, every passive law must "
      "add a damping of at least (1 - eta) times the inertia times that frequency in rad/s. Under "
      "the proposed coupling eta scales the damping, and so the force felt in slow motion. By "
      "equation (12) the inertia felt would be eta times the arm's own; the measured inertia "
      "differs. Above eta = 1 the inertia felt is negative up to 5 Hz. Last panel: the arm moves "
      "freely in an undamped grip of 3000 N/m, with motors that have practically no limit.",
      1e3 * kAmplitude, kLightGrip, kLightGripDamping, lab.arm().readings ? "" : "; exact encoders",
      Parameters{}.band);
  outcome.figure.columns = 2;
  outcome.figure.panels = panels(laws);
  judge_predictive(of(laws, CouplingKind::predictive), outcome.checks);
  judge_proposed(of(laws, CouplingKind::proposed), outcome.checks);
  roam(lab, outcome);
  return outcome;
}

}  // namespace limpid
