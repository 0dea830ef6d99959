// Fig. 6 in a human hand.
#include <algorithm>

#include "app/experiments/contact_series.h"
#include "app/experiments/live.h"
#include "app/experiments/series.h"

namespace limpid {
namespace {

constexpr double kPassivitySeconds = 20;
constexpr double kHighestLive = 4e-3;  // of encoders' steps and friction that nobody knows [J]

}  // namespace

Outcome live_passivity(LiveLaboratory& lab) {
  struct Law {
    CouplingKind kind;
    const char* ink;
  };
  constexpr Law kRuns[] = {{CouplingKind::standard, kStandardInk},
                           {CouplingKind::proposed, kProposedInk},
                           {CouplingKind::predictive, kPredictiveInk}};
  Outcome outcome;
  outcome.figure.title = "Energy that the coupling adds, in your hand";
  outcome.figure.caption =
      "Controller energy E_c in free motion, taps and circles on the surface. It may fall; what "
      "rises above zero was made by the coupling.";
  FigurePanel energy{.title = "Total", .x_label = "time [s]", .y_label = "energy [mJ]"};
  for (const Law& law : kRuns) {
    Parameters p = lab.parameters;
    p.kind = law.kind;
    const std::string label = name(law.kind);
    const Session s = lab.run(
        {label, p, kPassivitySeconds,
         "The " + label + " coupling: move freely, tap the surface, draw circles on it, 20 s."});
    double highest = 0;
    for (std::size_t k = 0; k < s.size(); ++k) {
      highest = worse(highest, s.at(k, Column::energy_total)[0]);
    }
    energy.series.push_back(over_time(s, label, law.ink, Series::Style::line, [&](auto k) {
      return 1e3 * s.at(k, Column::energy_total)[0];
    }));
    // Who touches nothing has shown nothing.
    outcome.checks.push_back(
        at_least("lasting contacts, " + label + " coupling", lasting_contacts(s), 1));
    outcome.checks.push_back(
        at_most("highest E_c, " + label + " coupling [J]", highest, kHighestLive));
  }
  outcome.figure.panels = {energy};
  return outcome;
}

}  // namespace limpid
