#include <fmt/format.h>

#include <algorithm>

#include "app/identify/identify_report.h"

namespace limpid {
namespace {

const std::string& name_of(const Identification& identification, Eigen::Index joint) {
  return identification.found.arm.joints[static_cast<std::size_t>(joint)].name;
}

FigurePanel torque_panel(const Identification& identification, Eigen::Index joint) {
  Series told{
      .label = "measured", .color = kDeviceInk, .style = Series::Style::points, .points = {}};
  double least = 0, most = 0;
  for (const Explained& m : identification.found.moments) {
    if (m.joint != joint) continue;
    told.points.push_back({1e3 * (m.bodies + m.springs + m.friction), 1e3 * m.torque});
    least = std::min(least, told.points.back().y), most = std::max(most, told.points.back().y);
  }
  const Series same{.label = "all explained",
                    .color = kProxyInk,
                    .style = Series::Style::line,
                    .points = {{least, least}, {most, most}}};
  return {.title = name_of(identification, joint) + ": torque",
          .x_label = "torque that what was found explains [mN m]",
          .y_label = "the motor's [mN m]",
          .series = {told, same}};
}

// What is left of the torque without inertia, weight and springs.
FigurePanel friction_panel(const Identification& identification, Eigen::Index joint) {
  const JointFinding& finding = identification.found.joints[static_cast<std::size_t>(joint)];
  Series left{.label = "measured, without the others",
              .color = kDeviceInk,
              .style = Series::Style::points,
              .points = {}};
  double slowest = 0, fastest = 0;
  for (const Explained& m : identification.found.moments) {
    if (m.joint != joint) continue;
    left.points.push_back({m.velocity, 1e3 * (m.torque - m.bodies - m.springs)});
    slowest = std::min(slowest, m.velocity), fastest = std::max(fastest, m.velocity);
  }
  const double coulomb = 1e3 * finding.coulomb.value, viscous = 1e3 * finding.viscous.value;
  const Series back{.label = "friction that was found",
                    .color = kProxyInk,
                    .style = Series::Style::line,
                    .points = {{slowest, viscous * slowest - coulomb}, {0, -coulomb}}};
  const Series forth{.label = "",
                     .color = kProxyInk,
                     .style = Series::Style::line,
                     .points = {{0, coulomb}, {fastest, viscous * fastest + coulomb}}};
  return {.title = name_of(identification, joint) + ": friction",
          .x_label = "velocity [rad/s]",
          .y_label = "torque [mN m]",
          .series = {left, back, forth}};
}

FigurePanel readings_panel(const ReadingTimes& timing) {
  constexpr int kBins = 60;
  const double most = std::max(1e-4, 1.2 * timing.p99);
  std::vector<double> count(kBins, 0);
  for (const double interval : timing.intervals) {
    const auto bin = static_cast<int>(interval / most * kBins);
    if (bin >= 0 && bin < kBins) ++count[static_cast<std::size_t>(bin)];
  }
  Series bars{.label = "", .color = kDeviceInk, .style = Series::Style::line, .points = {}};
  for (int i = 0; i < kBins; ++i) {
    const double share = 100 * count[static_cast<std::size_t>(i)] /
                         static_cast<double>(std::max<std::size_t>(1, timing.intervals.size()));
    bars.points.push_back({1e3 * most * i / kBins, share});
    bars.points.push_back({1e3 * most * (i + 1) / kBins, share});
  }
  return {.title = "readings",
          .x_label = "time between two [ms]",
          .y_label = "share [%]",
          .series = {bars}};
}

}  // namespace

Figure identify_figure(const Identification& identification) {
  Figure figure{.title = "Identification of " + identification.device,
                .caption = fmt::format("delay {} ms", text_of(identification.found.delay, 1e-3)),
                .columns = 2,
                .panel_height = 300,
                .panels = {}};
  for (Eigen::Index j = 0; j < identification.bare.record.joints(); ++j) {
    figure.panels.push_back(torque_panel(identification, j));
    figure.panels.push_back(friction_panel(identification, j));
  }
  if (!identification.bare.timing.intervals.empty()) {
    figure.panels.push_back(readings_panel(identification.bare.timing));
  }
  return figure;
}

}  // namespace limpid
