// The stiffest wall in a human hand: the hand taps and presses, the wall doubles until it buzzes.
#include <fmt/format.h>

#include <algorithm>

#include "app/experiments/contact_series.h"
#include "app/experiments/live.h"
#include "app/experiments/wall_search.h"

namespace limpid {
namespace {

constexpr double kZwidthSeconds = 6;
constexpr double kSoft = 250;                 // the first wall [N/m]
constexpr std::size_t kZwidthTouching = 500;  // rows without which nothing is known

struct Wall {
  double stiffness, chatter;
  bool renders;
};

Wall tap(LiveLaboratory& lab, const Parameters& p, double stiffness) {
  lab.stiffen(stiffness);
  const Session s =
      lab.run({fmt::format("{}-{:.0f}", name(p.kind), stiffness), p, kZwidthSeconds,
               fmt::format("A wall of {:.0f} N/m, {} coupling: tap it, press, hold, 6 s.",
                           stiffness, name(p.kind))});
  std::size_t touching = 0;
  for (std::size_t k = 0; k < s.size(); ++k) touching += contact_torque(s, k) > 0;
  if (touching < kZwidthTouching)
    throw std::runtime_error("the wall was hardly touched; once more");
  const double chatter = chatter_in_contact(s, lab.arm);
  return {stiffness, chatter, chatter <= WellRendered::kChatter};
}

}  // namespace

Outcome live_zwidth(LiveLaboratory& lab) {
  Outcome outcome;
  outcome.figure.title = "The stiffest wall that does not buzz in your hand";
  outcome.figure.caption = fmt::format(
      "Walls from {} N/m on, each twice as stiff, tapped and pressed until the tip moves faster "
      "than {} mm/s above 20 Hz in contact.",
      kSoft, 1e3 * WellRendered::kChatter);
  FigurePanel panel{.title = "Chatter in contact",
                    .x_label = "stiffness of the wall [N/m]",
                    .y_label = "speed above 20 Hz [mm/s]",
                    .log_x = true};
  double stiffest[2] = {};
  constexpr CouplingKind kRuns[] = {CouplingKind::proposed, CouplingKind::predictive};
  constexpr const char* kInks[] = {kProposedInk, kPredictiveInk};
  for (std::size_t i = 0; i < 2; ++i) {
    Parameters p = lab.parameters;
    p.kind = kRuns[i];
    Series line{name(p.kind), kInks[i], Series::Style::line, {}};
    bool renders = true;
    for (double k = kSoft; renders && k <= kStiffest; k *= 2) {
      const Wall wall = tap(lab, p, k);
      renders = wall.renders;
      if (renders) stiffest[i] = k;
      line.points.push_back({k, 1e3 * wall.chatter});
    }
    panel.series.push_back(line);
  }
  outcome.figure.panels = {panel};
  outcome.checks = {at_least("stiffest wall, proposed coupling [N/m]", stiffest[0], kSoft),
                    at_least("stiffest wall, predictive coupling, over that of the proposed one",
                             stiffest[1] / std::max(kSoft, stiffest[0]), 1)};
  return outcome;
}

}  // namespace limpid
