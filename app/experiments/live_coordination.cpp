// Figs. 3 and 4 in a human hand.
#include <cmath>

#include "app/experiments/contact_series.h"
#include "app/experiments/live.h"

namespace limpid {
namespace {

constexpr double kSeconds = 20;
constexpr int kContacts = 3;

}  // namespace

Outcome live_coordination(LiveLaboratory& lab) {
  struct Run {
    CouplingKind kind;
    const char* ink;
    Session session = {};
  };
  Run runs[] = {{CouplingKind::standard, kStandardInk}, {CouplingKind::proposed, kProposedInk}};
  Outcome outcome;
  Figure& figure = outcome.figure;
  figure.title = "Coordination of device and proxy in your hand";
  figure.caption =
      "The tip pressed onto the surface and let go again, as often and as hard as the hand liked.";
  figure.columns = 2;
  FigurePanel force{
      .title = "Contact torque |f2|", .x_label = "time [s]", .y_label = "torque [N m]"};
  FigurePanel error{
      .title = "Coordination error |x1 - x2|", .x_label = "time [s]", .y_label = "error [mrad]"};
  FigurePanel scatter{.title = "Coordination error against contact torque",
                      .x_label = "contact torque |f2| [N m]",
                      .y_label = "error |x1 - x2| [mrad]"};
  for (Run& run : runs) {
    Parameters p = lab.parameters;
    p.kind = run.kind;
    const std::string law = name(run.kind);
    run.session = lab.run({law, p, kSeconds,
                           "The " + law +
                               " coupling: press the tip onto the surface, hold, let go; three "
                               "times or more, 20 s."});
    const Session& s = run.session;
    force.series.push_back(over_time(s, law, run.ink, Series::Style::line,
                                     [&](auto k) { return contact_torque(s, k); }));
    error.series.push_back(error_over_time(s, law, run.ink));
    add_contact_scatter(scatter, s, law, run.ink);
    outcome.checks.push_back(
        at_least("lasting contacts, " + law + " coupling", lasting_contacts(s), kContacts));
  }
  figure.panels = {force, error, scatter};
  const double standard = contact_slope(runs[0].session);
  outcome.checks.push_back(
      at_most("slope of the error, standard coupling, over 1/k_vc, off 1 by at most",
              std::abs(standard * lab.parameters.k_vc - 1), 0.2));
  outcome.checks.push_back(at_most("slope of the error, proposed over standard coupling",
                                   contact_slope(runs[1].session) / standard, 0.2));
  return outcome;
}

}  // namespace limpid
