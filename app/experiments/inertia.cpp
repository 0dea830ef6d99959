// Fig. 5: human torque for the same free motion with eta 0.6, 1 and 5.
#include <fmt/format.h>

#include <cmath>

#include "app/experiments/signals.h"

namespace limpid {
namespace {

constexpr double kInertiaEtas[] = {0.6, 1, 5};
// A grip stiff enough that the three motions are the same.
constexpr double kGripStiffness = 6000;  // [N/m]
constexpr double kGripDamping = 20;      // [N s/m]

double largest_difference(const Session& a, const Session& b) {
  double difference = 0, range = 0;
  const Eigen::VectorXd start = vector_at(a, 0, Column::device_position);
  for (std::size_t k = 0; k < a.size(); ++k) {
    const Eigen::VectorXd x = vector_at(a, k, Column::device_position);
    difference = worse(difference, (x - vector_at(b, k, Column::device_position)).norm());
    range = worse(range, (x - start).norm());
  }
  return difference / range;
}

}  // namespace

Outcome inertia(TrialRunner& lab) {
  const ExperimentArm& on = lab.arm();
  std::vector<Trial> trials;
  for (const double eta : kInertiaEtas) {
    Parameters p = on.settings;
    p.eta = eta;
    p.hand_stiffness = kGripStiffness;
    p.hand_damping = kGripDamping;
    trials.push_back({fmt::format("eta-{}", eta), plan_of(on.description, "free", "free", p)});
  }
  const std::vector<TrialResult> results = lab.run(trials);
  const Session& reference = results[1].session;  // eta = 1
  const double rms_at_one = rms_norm(reference, Column::hand_torque, 0, reference.size());

  Outcome outcome;
  outcome.figure.title = "The same free motion at three etas";
  outcome.figure.caption = fmt::format(
      "Proposed coupling at the {}, grip {} N/m and {} N s/m, no contact. In such a slow motion "
      "most of the force is damping, and eta scales the damping. The experiment `lightness` "
      "measures the inertia felt in faster motions.",
      on.gains(), kGripStiffness, kGripDamping);
  outcome.figure.columns = 2;
  FigurePanel torque{.title = "Human torque |f1| and its estimate",
                     .x_label = "time [s]",
                     .y_label = "torque [N m]"};
  FigurePanel motion{.title = "Shoulder angle: the same motion at all three etas",
                     .x_label = "time [s]",
                     .y_label = "x1 [rad]"};
  std::vector<Series> estimates;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Session& s = results[i].session;
    const double eta = kInertiaEtas[i];
    const std::string label = fmt::format("eta = {}", eta);
    torque.series.push_back(over_time(s, label, kFamilyInk[i], Series::Style::line, [&](auto k) {
      return vector_at(s, k, Column::hand_torque).norm();
    }));
    estimates.push_back(
        over_time(s, i == 0 ? "estimates" : "", kNeutralInk, Series::Style::dashed,
                  [&](auto k) { return vector_at(s, k, Column::hand_torque_estimate).norm(); }));
    const auto style = i == 0 ? Series::Style::line : Series::Style::dashed;
    motion.series.push_back(over_time(s, label, kFamilyInk[i], style,
                                      [&](auto k) { return s.at(k, Column::device_position)[1]; }));
    if (eta == 1) continue;
    const double rms = rms_norm(s, Column::hand_torque, 0, s.size());
    outcome.checks.push_back(at_most(fmt::format("rms human torque at eta = {}: relative deviation "
                                                 "from eta times the rms torque at eta = 1",
                                                 eta),
                                     std::abs(rms / (eta * rms_at_one) - 1), 0.10));
    outcome.checks.push_back(at_most(fmt::format("difference between the motions at eta = {} and "
                                                 "at eta = 1, divided by the range of motion",
                                                 eta),
                                     largest_difference(reference, s), 0.02));
  }
  torque.series.insert(torque.series.end(), estimates.begin(), estimates.end());
  outcome.figure.panels = {torque, motion};
  return outcome;
}

}  // namespace limpid
