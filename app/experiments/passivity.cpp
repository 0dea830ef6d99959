// Fig. 6: controller energy over many trials of free motion, contact and circles on the surface.
#include "app/experiments/passivity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/experiments/signals.h"
#include "app/run/analysis.h"
#include "app/run/varied_hand.h"
#include "core/dynamics/arm.h"

namespace limpid {

namespace {

const std::array<PassivityCase, 5> kCases{{
    {"eta = 0.6", "eta-0.6", CouplingKind::proposed, 0.6},
    {"eta = 1", "eta-1", CouplingKind::proposed, 1},
    {"eta = 3", "eta-3", CouplingKind::proposed, 3},
    {"eta = 5", "eta-5", CouplingKind::proposed, 5},
    {"standard", "standard", CouplingKind::standard, 1},
}};

constexpr std::size_t kGrid = 201;   // points of normalised time
constexpr double kNoise = 1e-4;      // energies up to this one count as zero [J]
constexpr double kStiffGrip = 3000;  // [N/m]
constexpr double kOffLimit = 0.1;    // distance of the two runs from Routh's limit, relative

// A trial's energy over normalised time, and its highest value.
struct Books {
  std::vector<double> total, commanded;  // kGrid [J]
  double highest_total = 0, highest_commanded = 0;
};

Books books_of(const Session& s) {
  Books books;
  for (std::size_t i = 0; i < kGrid; ++i) {
    const std::size_t k = i * (s.size() - 1) / (kGrid - 1);
    books.total.push_back(s.at(k, Column::energy_total)[0]);
    books.commanded.push_back(s.at(k, Column::energy_commanded)[0]);
  }
  for (std::size_t k = 0; k < s.size(); ++k) {
    books.highest_total = worse(books.highest_total, s.at(k, Column::energy_total)[0]);
    books.highest_commanded = worse(books.highest_commanded, s.at(k, Column::energy_commanded)[0]);
  }
  return books;
}

using Curve = std::vector<double> Books::*;

// Mean, lowest and highest curve of the trials of a case.
std::vector<FigurePoint> spread(std::span<const Books> trials, Curve curve) {
  std::vector<FigurePoint> points(kGrid);
  for (std::size_t i = 0; i < kGrid; ++i) {
    FigurePoint& p = points[i];
    p = {static_cast<double>(i) / (kGrid - 1), 0, std::numeric_limits<double>::infinity(),
         -std::numeric_limits<double>::infinity()};
    for (const Books& trial : trials) {
      const double energy = (trial.*curve)[i];
      p.y += energy / static_cast<double>(trials.size());
      p.low = std::min(p.low, energy);
      p.high = std::max(p.high, energy);
    }
  }
  return points;
}

void add_case(FigurePanel& panel, const PassivityCase& one, const char* color,
              std::span<const Books> trials, Curve curve) {
  std::vector<FigurePoint> points = spread(trials, curve);
  for (FigurePoint& p : points) p = {p.x, 1e3 * p.y, 1e3 * p.low, 1e3 * p.high};
  panel.series.push_back({"", color, Series::Style::band, points});
  const auto style =
      one.kind == CouplingKind::standard ? Series::Style::dashed : Series::Style::line;
  panel.series.push_back({one.name, color, style, points});
}

double final_mean(std::span<const Books> trials) { return spread(trials, &Books::total).back().y; }

double highest(std::span<const Books> trials, double Books::*energy) {
  double most = 0;
  for (const Books& trial : trials) most = worse(most, trial.*energy);
  return most;
}

// A hand in a stiff grip that holds still after a nudge of a tenth of a millimetre: the loop calms
// down on one side of Routh's limit and swings on the other.
Trial held_still(const ExperimentArm& on, double eta, const std::string& name) {
  Parameters p = on.settings;
  p.eta = eta;
  p.hand_stiffness = kStiffGrip;
  p.hand_damping = 0;
  Trial trial{name, plan_of(on.description, "free", "free", p)};
  const Vec3 start = trial.plan.hand.position.front();
  trial.plan.hand = parse_hand_csv(
      fmt::format("time_s,x_m,y_m,z_m\n0,{0},{1},{2}\n0.1,{0},{1},{2}\n0.12,{3},{4},{5}\n"
                  "1.6,{3},{4},{5}\n",
                  start.x(), start.y(), start.z(), start.x() + 1e-4, start.y() + 1e-4,
                  start.z() + 1e-4),
      "held still after a nudge");
  trial.plan.rows = rows_of(trial.plan);
  return trial;
}

double grip_limit(const ExperimentArm& on) {
  const Trial trial = held_still(on, 1, "");
  return analyze(trial.plan.arm, rest_pose(trial.plan.arm), trial.plan.parameters, std::nullopt)
      .eta_min_grip;
}

// Highest speed of each stretch, once something moves.
std::vector<FigurePoint> envelope(const Session& s) {
  constexpr std::size_t kStretch = 20;  // rows; spans some periods of the oscillation
  std::vector<FigurePoint> points;
  for (std::size_t from = 0; from + kStretch <= s.size(); from += kStretch) {
    double most = 0;
    for (std::size_t k = from; k < from + kStretch; ++k) {
      most = std::max(most, vector_at(s, k, Column::device_velocity).norm());
    }
    if (most > 1e-8) points.push_back({s.at(from, Column::time)[0], most});
  }
  return points;
}

// Motion at the end over motion soon after the nudge.
double growth(const TrialResult& result) {
  if (result.end.diverged) return std::numeric_limits<double>::infinity();
  const Session& s = result.session;
  const std::size_t length = s.size() / 8;
  return rms_norm(s, Column::device_velocity, s.size() - length, s.size()) /
         rms_norm(s, Column::device_velocity, length, 2 * length);
}

struct Runs {
  std::vector<PassivityCase> cases;  // the last is this experiment's own: eta = 0.4
  double limit = 0;                  // smallest eta of the stiff grip, by Routh and Hurwitz
  std::vector<Books> books;          // of each case's trials
  std::vector<TrialResult> held;     // in the stiff grip: above the limit, below it

  std::size_t compared() const { return cases.size() - 1; }
  std::span<const Books> of(std::size_t one) const {
    return std::span(books).subspan(one * kTrialsOfACase, kTrialsOfACase);
  }
};

std::vector<Trial> all_trials(const ExperimentArm& on, const Runs& runs, std::uint64_t seed) {
  std::vector<Trial> trials;
  for (const PassivityCase& one : runs.cases) {
    for (Trial& trial : passivity_trials(on, one, seed)) trials.push_back(std::move(trial));
  }
  // The last case is this experiment's own; the others' sessions also serve the spectrum.
  for (std::size_t i = runs.compared() * kTrialsOfACase; i < trials.size(); ++i) {
    trials[i].keep = false;
  }
  trials.push_back(held_still(on, runs.limit * (1 + kOffLimit), "grip-above"));
  trials.push_back(held_still(on, runs.limit * (1 - kOffLimit), "grip-below"));
  trials.back().may_diverge = true;  // growth is checked
  return trials;
}

Runs run_all(TrialRunner& lab) {
  Runs runs;
  runs.cases.assign(passivity_cases().begin(), passivity_cases().end());
  runs.cases.push_back({"predictive, eta = 0.6", "predictive-0.6", CouplingKind::predictive, 0.6});
  runs.cases.push_back({"eta = 0.4", "eta-0.4", CouplingKind::proposed, 0.4});
  runs.limit = grip_limit(lab.arm());
  const std::size_t many = runs.cases.size() * kTrialsOfACase;
  runs.books.resize(many);
  runs.held.resize(2);
  lab.run(all_trials(lab.arm(), runs, lab.seed()), [&](std::size_t i, const TrialResult& result) {
    if (i < many) {
      runs.books[i] = books_of(result.session);
    } else {
      runs.held[i - many] = result;
    }
  });
  return runs;
}

FigurePanel grip_panel(const std::vector<TrialResult>& held) {
  FigurePanel grip{.title = "Held in a stiff grip",
                   .x_label = "time [s]",
                   .y_label = "peak of the speed |v1| [rad/s]",
                   .log_y = true};
  for (std::size_t i = 0; i < 2; ++i) {
    const Session& s = held[i].session;
    const std::string label = fmt::format("eta {:.3f}, {} the limit", s.at(0, Column::eta)[0],
                                          i == 0 ? "above" : "below");
    grip.series.push_back(
        {label, i == 0 ? kHandInk : kContactInk, Series::Style::line, envelope(s)});
  }
  return grip;
}

Figure draw(const Runs& runs, const std::string& gains) {
  Figure figure;
  figure.title = "Energy that the coupling adds, over time";
  figure.caption = fmt::format(
      "Controller energy E_c in free motion, contact and circles on the table; {}. Lines: mean of "
      "{} trials. Bands: lowest to highest trial. The curve \"total\" includes the device's own "
      "damping, the curve \"commanded\" only motors and proxy. Last panel: a hand holds the device "
      "still. This hand is a spring of {} N/m without damping. By the criterion of Routh and "
      "Hurwitz the loop is then stable if eta is at least {:.3f}.",
      gains, kTrialsOfACase, kStiffGrip, runs.limit);
  figure.columns = 2;
  const FigurePanel axes{.x_label = "time / length of the trial [-]", .y_label = "energy [mJ]"};
  FigurePanel total = axes, commanded = axes, zero = axes;
  total.title = "Total";
  commanded.title = "Commanded";
  zero.title = "Commanded, where it changes sign";
  for (std::size_t i = 0; i < runs.compared(); ++i) {
    const bool standard = runs.cases[i].kind == CouplingKind::standard;
    const bool predictive = runs.cases[i].kind == CouplingKind::predictive;
    const char* color = standard ? kStandardInk : predictive ? kPredictiveInk : kFamilyInk[i];
    add_case(total, runs.cases[i], color, runs.of(i), &Books::total);
    add_case(commanded, runs.cases[i], color, runs.of(i), &Books::commanded);
  }
  add_case(zero, runs.cases[runs.compared()], kFamilyInk[4], runs.of(runs.compared()),
           &Books::commanded);
  add_case(zero, runs.cases[0], kFamilyInk[0], runs.of(0), &Books::commanded);
  figure.panels = {total, commanded, zero, grip_panel(runs.held)};
  return figure;
}

std::vector<Check> judge(const Runs& runs) {
  std::vector<Check> checks;
  for (std::size_t i = 0; i < runs.compared(); ++i) {
    checks.push_back(
        at_most(fmt::format("highest total E_c of all trials, {} [J]", runs.cases[i].name),
                highest(runs.of(i), &Books::highest_total), kNoise));
  }
  for (std::size_t i = 0; i < runs.compared(); ++i) {
    checks.push_back(
        at_most(fmt::format("highest commanded E_c of all trials, {} [J]", runs.cases[i].name),
                highest(runs.of(i), &Books::highest_commanded), kNoise));
  }
  // Order: 0.6 above standard above 3; 0.6 above 1 above 3 above 5.
  for (const auto& [low, high] : {std::pair(4, 0), {2, 4}, {1, 0}, {2, 1}, {3, 2}}) {
    const auto l = static_cast<std::size_t>(low), h = static_cast<std::size_t>(high);
    checks.push_back(at_most(fmt::format("mean of the final total E_c: {} minus {} [J]",
                                         runs.cases[l].name, runs.cases[h].name),
                             final_mean(runs.of(l)) - final_mean(runs.of(h)), 0));
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Books& trial : runs.of(runs.compared()))
    least = worse_low(least, trial.highest_commanded);
  checks.push_back(
      at_least("highest commanded E_c at eta = 0.4 (not passive), in each trial, lower limit [J]",
               least, kNoise));
  checks.push_back(at_most(
      fmt::format(
          "stiff grip, eta {:.3f}: motion after 1.5 s, divided by motion just after a small push",
          runs.limit * (1 + kOffLimit)),
      growth(runs.held[0]), 0.5));
  checks.push_back(at_least(
      fmt::format(
          "stiff grip, eta {:.3f}: motion after 1.5 s, divided by motion just after a small push",
          runs.limit * (1 - kOffLimit)),
      growth(runs.held[1]), 2));
  return checks;
}

}  // namespace

std::span<const PassivityCase> passivity_cases() { return kCases; }

std::vector<Trial> passivity_trials(const ExperimentArm& on, const PassivityCase& one,
                                    std::uint64_t seed) {
  Parameters p = on.settings;
  p.kind = one.kind;
  p.eta = one.eta;
  std::vector<Trial> trials;
  for (std::size_t i = 0; i < kTrialsOfACase; ++i) {
    Trial trial{fmt::format("{}-{}", one.file_name, i),
                plan_of(on.description, "table", "circle", p)};
    trial.folder = "passivity";
    trial.plan.seed = seed;
    if (i > 0) {
      trial.plan.hand = varied(trial.plan.hand, seed, i);
      trial.plan.rows = rows_of(trial.plan);
    }
    trials.push_back(std::move(trial));
  }
  return trials;
}

Outcome passivity(TrialRunner& lab) {
  const Runs runs = run_all(lab);
  Outcome outcome;
  outcome.figure = draw(runs, lab.arm().gains());
  outcome.checks = judge(runs);
  return outcome;
}

}  // namespace limpid
