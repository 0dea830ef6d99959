#include "app/experiments/identify_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/markup.h"
#include "app/plot/figure.h"
#include "app/run/provenance.h"
#include "app/run/urdf_writer.h"
#include "devices/files/atomic_file.h"
#include "devices/files/text_file.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
  const std::string wrong = try_write_atomically(file, text);
  if (!wrong.empty()) throw FileError(wrong);
}

std::string cell(const std::string& text) {
  return "<td class=\"number\">" + escaped(with_plus_minus(text)) + "</td>";
}

std::string joints_table(const Identification& identification) {
  const Identified& found = identification.found;
  std::string head = "<th>joint</th>", rows;
  for (const FindingInfo& info : kFindings) {
    head +=
        fmt::format("<th class=\"number\">{} [{}]</th>", info.label, escaped(typeset(info.unit)));
  }
  for (std::size_t j = 0; j < found.joints.size(); ++j) {
    rows += "<tr><td>" + escaped(found.arm.joints[j].name) + "</td>";
    for (const FindingInfo& info : kFindings) {
      rows += cell(text_of(found.joints[j].*info.field, info.per_unit));
    }
    rows += cell(fmt::format("{:.3f}", identification.inertia_in_file[j] / 1e-3)) +
            cell(fmt::format("{:.1f} %", 100 * found.joints[j].residual / found.joints[j].torque)) +
            "</tr>\n";
  }
  return fmt::format(
      "<table><thead><tr>{}<th class=\"number\">inertia in its file [g m²]</th>"
      "<th class=\"number\">not explained</th></tr></thead><tbody>\n{}</tbody></table>\n",
      head, rows);
}

std::string drift_section(const std::vector<Drift>& all, const std::string& when) {
  std::string rows;
  for (const Drift& d : all) {
    rows += fmt::format("<tr><td>{}</td><td>{}</td>{}{}<td class=\"verdict\">{}</td></tr>\n",
                        escaped(d.what), escaped(d.unit), cell(text_of(d.before, 1)),
                        cell(text_of(d.now, 1)), d.certain ? "changed" : "");
  }
  return fmt::format(
      "<section><header><h2>Since last time</h2></header><p class=\"soft\">{}</p>\n"
      "<table><thead><tr><th>what</th><th>unit</th><th class=\"number\">then</th>"
      "<th class=\"number\">now</th><th></th></tr></thead><tbody>\n{}</tbody></table></section>\n",
      escaped(when), rows);
}

void write_report(const Identification& identification, const std::optional<Findings>& last,
                  bool pictures, const fs::path& file) {
  std::string body =
      "<section><header><h2>What was found</h2></header>\n" + joints_table(identification) + "<p>" +
      escaped(device_text(identification)) +
      "</p>\n<p class=\"soft\">\xC2\xB1: one standard deviation. Inertia and weight at the middle "
      "of the range of motion. <a href=\"identified.urdf\">arm</a>, <a "
      "href=\"identified.json\">values</a>, <a href=\"motion.csv\">motion</a></p>";
  if (pictures) {
    body +=
        "<figure><img src=\"identified.svg\" alt=\"measured torques and the torques of the "
        "identified model\"><figcaption><a href=\"identified.csv\">data</a>, <a "
        "href=\"identified.png\">picture</a></figcaption></figure>";
  }
  body += "</section>\n";
  const auto changes = last ? drift(*last, identification) : std::vector<Drift>{};
  if (!changes.empty()) body += drift_section(changes, last->when);
  const std::optional<std::uint64_t> seed = identification.order.seed;
  write_page(file, "Identification of " + identification.device,
             "Arm from which the identification started: " + identification.order.guess.name + "." +
                 (seed ? fmt::format(" Seed of the simulated device: {}.", *seed) : ""),
             body);
}

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
          .x_label = "torque explained by the identified model [mN m]",
          .y_label = "torque of the motor [mN m]",
          .series = {told, same}};
}

// Torque without inertia, weight and springs, over velocity.
FigurePanel friction_panel(const Identification& identification, Eigen::Index joint) {
  const JointFinding& finding = identification.found.joints[static_cast<std::size_t>(joint)];
  Series left{.label = "measured, without inertia, weight and springs",
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
  const Series back{.label = "identified friction",
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
          .x_label = "time between two readings [ms]",
          .y_label = "share [%]",
          .series = {bars}};
}

}  // namespace

std::string identified_urdf(const Identification& identification) {
  return urdf_text(
      identification.found.arm,
      fmt::format("identified by {} on {}, from {}", provenance("", identification.order.seed),
                  identification.device, identification.order.guess.name));
}

DeviceHub::Profile profile_of(const Identification& identification) {
  return {.urdf = identified_urdf(identification),
          .report = findings_text(identification),
          .delay = identification.found.delay.value,
          .torque_scale = identification.torque_scale ? identification.torque_scale->value : 1};
}

void write_motion(const IdentifyRun& run, const fs::path& file) {
  const MotionRecord& record = run.record;
  std::string text = "time";
  for (Eigen::Index j = 1; j <= record.joints(); ++j) text += fmt::format(",x{}", j);
  for (Eigen::Index j = 1; j <= record.joints(); ++j) text += fmt::format(",torque{}", j);
  text += '\n';
  for (Eigen::Index i = 0; i < record.rows(); ++i) {
    text += fmt::format("{:.3f}", static_cast<double>(i) * record.T);
    for (const Eigen::MatrixXd* columns : {&record.x, &record.torque}) {
      for (const double value : columns->row(i)) text += fmt::format(",{:.9g}", value);
    }
    text += '\n';
  }
  write(file, text);
}

std::string write_identification(const Identification& identification,
                                 const std::optional<Findings>& last, const fs::path& dir,
                                 const std::string& more) {
  write(dir / "identified.urdf", identified_urdf(identification));
  write(dir / "identified.json", findings_text(identification, more));
  Figure figure = identify_figure(identification);
  figure.made_by = provenance("", identification.order.seed);
  write_figure_data(figure, dir / "identified.csv");
  std::string wrong;
  try {
    draw_figure(figure, dir, "identified");
  } catch (const std::exception& e) {
    wrong = e.what();
  }
  write_report(identification, last, wrong.empty(), dir / "report.html");
  return wrong;
}

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
