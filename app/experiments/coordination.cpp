// Figs. 3 and 4: device and proxy in three contacts of the proximal link and three of the tip.
#include "app/experiments/coordination.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace limpid {

namespace {

constexpr double kTouching = 1e-6;        // |f2| above this is contact [N m]
constexpr std::size_t kScatterStep = 12;  // rows a dot

// |x_E| against |f2| at every `step`th row in contact, both in SI.
std::vector<FigurePoint> in_contact(const Session& s, std::size_t step) {
  std::vector<FigurePoint> points;
  for (std::size_t k = 0; k < s.size(); k += step) {
    const double f2 = contact_torque(s, k);
    if (f2 > kTouching) points.push_back({f2, coordination_error(s, k).norm()});
  }
  return points;
}

constexpr const char* kJointNames[] = {"Turret", "Shoulder", "Elbow"};
constexpr double kInertiaErrors[] = {0.5, 2};

double largest_error(const Session& s) {
  double largest = 0;
  for (std::size_t k = 0; k < s.size(); ++k) {
    largest = worse(largest, coordination_error(s, k).norm());
  }
  return largest;
}

FigurePanel joint_panel(const Session& s, std::size_t joint, const std::string& coupling) {
  FigurePanel panel{.title = fmt::format("{}, {} coupling", kJointNames[joint], coupling),
                    .x_label = "time [s]",
                    .y_label = "angle [rad]"};
  panel.series.push_back(over_time(s, "device x1", kDeviceInk, Series::Style::line, [&](auto k) {
    return s.at(k, Column::device_position)[joint];
  }));
  panel.series.push_back(over_time(s, "proxy x2", kProxyInk, Series::Style::dashed,
                                   [&](auto k) { return s.at(k, Column::proxy_position)[joint]; }));
  return panel;
}

Series added_error(const Session& s, const Session& right, const std::string& label,
                   const char* color) {
  return over_time(s, label, color, Series::Style::line, [&](auto k) {
    return 1e6 * (coordination_error(s, k).norm() - coordination_error(right, k).norm());
  });
}

std::vector<Trial> all_trials(const ArmDescription& arm, const Parameters& standard,
                              const Parameters& proposed) {
  const auto plan = [&](const Parameters& p) { return plan_of(arm, "proximal", "proximal", p); };
  std::vector<Trial> trials{{"standard", plan(standard)}, {"proposed", plan(proposed)}};
  for (const double error : kInertiaErrors) {
    Parameters wrong = proposed;
    wrong.inertia_error = error;
    trials.push_back({fmt::format("inertia-error-{}", error), plan(wrong)});
  }
  return trials;
}

// `results` as all_trials() lists them.
Figure draw(const std::vector<TrialResult>& results, const Parameters& proposed,
            const std::string& gains) {
  const Session& a = results[0].session;
  const Session& b = results[1].session;
  Figure figure;
  figure.title = "Coordination of device and proxy in contact";
  figure.caption = fmt::format(
      "There are three contacts on the proximal link (20 N m/rad), then three at the tip (600 "
      "N/m). The hand is the same under both couplings: grip {} N/m and {} N s/m, {}, eta = {}.",
      proposed.hand_stiffness, proposed.hand_damping, gains, proposed.eta);
  figure.columns = 2;
  figure.panel_height = 300;
  for (std::size_t joint = 0; joint < 3; ++joint) {
    figure.panels.push_back(joint_panel(a, joint, "standard"));
    figure.panels.push_back(joint_panel(b, joint, "proposed"));
  }
  FigurePanel force{
      .title = "Contact torque |f2|", .x_label = "time [s]", .y_label = "torque [N m]"};
  FigurePanel error{
      .title = "Coordination error |x1 - x2|", .x_label = "time [s]", .y_label = "error [mrad]"};
  for (const auto& [s, label, color] :
       {std::tuple(&a, "standard", kStandardInk), std::tuple(&b, "proposed", kProposedInk)}) {
    force.series.push_back(
        over_time(*s, label, color, Series::Style::line,
                  [&session = *s](auto k) { return contact_torque(session, k); }));
    error.series.push_back(error_over_time(*s, label, color));
  }
  FigurePanel scatter{.title = "Coordination error against contact torque",
                      .x_label = "contact torque |f2| [N m]",
                      .y_label = "error |x1 - x2| [mrad]"};
  add_contact_scatter(scatter, a, "standard", kStandardInk);
  add_contact_scatter(scatter, b, "proposed", kProposedInk);
  FigurePanel wrong{.title = "Proposed coupling: error added by a wrong inertia in the model",
                    .x_label = "time [s]",
                    .y_label = "change of the error [μrad]"};
  wrong.series.push_back(added_error(results[2].session, b, "half the inertia", kProxyInk));
  wrong.series.push_back(added_error(results[3].session, b, "twice the inertia", kEnergyInk));
  figure.panels.insert(figure.panels.end(), {force, error, scatter, wrong});
  return figure;
}

// `ideal`: the standard coupling's slope by (1) [rad/(N m)].
std::vector<Check> judge(const std::vector<TrialResult>& results, double ideal) {
  const Session& a = results[0].session;
  const Session& b = results[1].session;
  std::vector<Check> checks = {
      at_least("contacts made with the standard coupling", lasting_contacts(a), 6),
      at_least("contacts made with the proposed coupling", lasting_contacts(b), 6),
      at_most("standard coupling: slope of the error divided by 1/k_vc, deviation from 1",
              std::abs(contact_slope(a) / ideal - 1), 0.02),
      at_most("slope of the error, proposed coupling divided by standard coupling",
              contact_slope(b) / contact_slope(a), 0.01),
      at_most("largest error, proposed coupling divided by standard coupling",
              largest_error(b) / largest_error(a), 0.1),
  };
  for (std::size_t i = 0; i < std::size(kInertiaErrors); ++i) {
    const Session& s = results[2 + i].session;
    checks.push_back(at_most(fmt::format("largest error if the model has {} times the inertia, "
                                         "divided by the largest error with the right inertia",
                                         kInertiaErrors[i]),
                             largest_error(s) / largest_error(b), 1.25));
    checks.push_back(at_most(fmt::format("slope of the error if the model has {} times the "
                                         "inertia, divided by the slope of the standard coupling",
                                         kInertiaErrors[i]),
                             contact_slope(s) / contact_slope(a), 0.01));
  }
  return checks;
}

}  // namespace

double contact_torque(const Session& s, std::size_t k) {
  return vector_at(s, k, Column::contact_torque).norm();
}

double contact_slope(const Session& s) { return slope_through_origin(in_contact(s, 1)); }

int lasting_contacts(const Session& s) {
  constexpr std::size_t kLasting = 100;  // rows
  int count = 0;
  std::size_t run = 0, pause = kLasting;
  for (std::size_t k = 0; k < s.size(); ++k) {
    if (contact_torque(s, k) > kTouching) {
      if (++run == kLasting && pause >= kLasting) ++count;
      if (run == kLasting) pause = 0;
    } else {
      run = 0;
      ++pause;
    }
  }
  return count;
}

Series error_over_time(const Session& s, const std::string& label, const char* color) {
  return over_time(s, label, color, Series::Style::line,
                   [&](auto k) { return 1e3 * coordination_error(s, k).norm(); });
}

void add_contact_scatter(FigurePanel& panel, const Session& s, const std::string& label,
                         const char* color) {
  Series dots{"", color, Series::Style::points, in_contact(s, kScatterStep)};
  double reach = 0;
  for (FigurePoint& p : dots.points) {
    reach = std::max(reach, p.x);
    p.y *= 1e3;
  }
  const double rise = contact_slope(s);
  panel.series.push_back(std::move(dots));
  panel.series.push_back({fmt::format("{}: {:.3g} mrad/(N m)", label, 1e3 * rise),
                          color,
                          Series::Style::line,
                          {{0, 0}, {reach, 1e3 * rise * reach}}});
}

Outcome coordination(TrialRunner& lab) {
  const Parameters& proposed = lab.arm().settings;
  Parameters standard = proposed;
  standard.kind = CouplingKind::standard;
  const std::vector<TrialResult> results =
      lab.run(all_trials(lab.arm().description, standard, proposed));
  Outcome outcome;
  outcome.figure = draw(results, proposed, lab.arm().gains());
  outcome.checks = judge(results, 1 / standard.k_vc);
  return outcome;
}

}  // namespace limpid
