// Fig. 5 in a human hand, which never moves twice alike: what counts is torque by acceleration and
// by speed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/live.h"
#include "app/experiments/series.h"
#include "app/run/analysis.h"
#include "core/dynamics/arm.h"

namespace limpid {
namespace {

constexpr double kInertiaSeconds = 15;
constexpr double kMargin = 1.1;    // of the least eta that is passive
constexpr double kOff = 0.25;      // of what is promised: hands and arms differ
constexpr double kLargest = 1.75;  // eta

// Of (24) where the hand is slow: Z = eta (b + s m (1 + (1 - eta) b / alpha)). The estimate lags by
// m / alpha, and what it lags by of the damping acts like inertia.
double promised_inertia(const Parameters& p, double b) {
  return p.eta * (1 + (1 - p.eta) * b / p.alpha);
}

LiveTrial swing(const Parameters& p) {
  return {
      fmt::format("eta-{:.2f}", p.eta), p, kInertiaSeconds,
      fmt::format("eta = {:.2f}: swing the tip through free space, about once a second, without "
                  "touching anything, 15 s.",
                  p.eta)};
}

}  // namespace

Outcome live_inertia(LiveLaboratory& lab) {
  Parameters p = lab.parameters;
  p.kind = CouplingKind::proposed;
  const double least = analyze(lab.arm, rest_pose(lab.arm), p, std::nullopt).eta_min;
  const double b = device_damping(lab.arm, p).mean() + p.b_v + p.k_vc * p.tick / 2;
  const double etas[] = {1, std::max(0.6, kMargin * least), kLargest};
  Outcome outcome;
  outcome.figure.title = "What a hand feels of the arm, at three etas";
  outcome.figure.caption =
      "Free motion, the proposed coupling. Found from the estimate of the hand's torque, the "
      "observer's lag taken out, along M(x1) a1 and v1; by what was found at eta = 1. Lines: (24).";
  outcome.figure.columns = 2;
  FigurePanel torque{.title = "Estimate of the human torque |f1|",
                     .x_label = "time [s]",
                     .y_label = "torque [N m]"};
  FigurePanel share{
      .title = "Felt, by that at eta = 1", .x_label = "eta [-]", .y_label = "share [-]"};
  Series inertia{"inertia", kProposedInk, Series::Style::points, {}};
  Series damping{"damping", kHandInk, Series::Style::points, {}};
  Felt at_one;
  for (std::size_t i = 0; i < std::size(etas); ++i) {
    p.eta = etas[i];
    const Session s = lab.run(swing(p));
    torque.series.push_back(
        over_time(s, fmt::format("eta = {:.2f}", p.eta), kFamilyInk[i], Series::Style::line,
                  [&](auto k) { return vector_at(s, k, Column::hand_torque_estimate).norm(); }));
    const Felt felt = felt_of(s, lab.arm);
    if (i == 0) at_one = felt;
    const double mass = felt.inertia / at_one.inertia;
    const double drag = felt.damping.mean() / at_one.damping.mean();
    inertia.points.push_back({p.eta, mass});
    damping.points.push_back({p.eta, drag});
    if (i == 0) {
      outcome.checks.push_back(
          at_least("inertia felt at eta = 1, by the model's", felt.inertia, 0.5));
      continue;
    }
    outcome.checks.push_back(
        at_most(fmt::format("inertia felt at eta = {:.2f}, by that at 1, off (24) by", p.eta),
                std::abs(mass - promised_inertia(p, b)), kOff));
    outcome.checks.push_back(
        at_most(fmt::format("damping felt at eta = {:.2f}, by that at 1, off eta by", p.eta),
                std::abs(drag - p.eta), kOff));
  }
  Series of_inertia{"", kProposedInk, Series::Style::dashed, {}};
  Series of_damping{"", kHandInk, Series::Style::dashed, {}};
  for (p.eta = 0.4; p.eta <= 2; p.eta += 0.05) {
    of_inertia.points.push_back({p.eta, promised_inertia(p, b)});
    of_damping.points.push_back({p.eta, p.eta});
  }
  share.series = {inertia, damping, of_inertia, of_damping};
  outcome.figure.panels = {torque, share};
  return outcome;
}

}  // namespace limpid
