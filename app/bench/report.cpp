#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/bench/bench.h"

namespace limpid::bench {
namespace {

nlohmann::ordered_json json_of(const Machine& m) {
  return {{"processor", m.processor}, {"processors", m.processors}, {"kernel", m.kernel},
          {"compiler", m.compiler},   {"haptic_thread", m.threads}, {"counts", m.counts}};
}

nlohmann::ordered_json json_of(const Line& line) {
  nlohmann::ordered_json json{{"id", line.id},         {"what", line.what}, {"unit", line.unit},
                              {"median", line.median}, {"p99", line.p99},   {"p99.9", line.p999},
                              {"max", line.largest}};
  if (line.ratio) {
    json["of"] = line.of;
    json["ratio"] = *line.ratio;
  }
  if (line.instructions) json["instructions"] = *line.instructions;
  if (line.real_time) json["real_time"] = *line.real_time;
  return json;
}

// In us as far as that can be read.
std::string time_text(double us) {
  if (us < 9.995) return fmt::format("{:.2f}", us);
  if (us < 9999) return fmt::format("{:.{}f}", us, us < 99.95 ? 1 : 0);
  return us < 999.5e3 ? fmt::format("{:.3g} ms", 1e-3 * us) : fmt::format("{:.3g} s", 1e-6 * us);
}

}  // namespace

Line line_of(std::string id, std::string what, const Samples& times, const Line* yardstick) {
  Line line{std::move(id),       std::move(what),      "us",
            times.quantile(0.5), times.quantile(0.99), times.quantile(0.999),
            times.quantile(1)};
  if (yardstick != nullptr) {
    line.of = yardstick->id;
    line.ratio = line.median / yardstick->median;
  }
  return line;
}

std::string table_head() {
  return fmt::format("{:<46}{:>9}{:>9}{:>9}{:>9}{:>8}{:>14}\n", "times in us", "median", "p99",
                     "p99.9", "max", "ratio", "instructions");
}

std::string table_line(const Line& line) {
  const bool many = line.largest > line.median || line.p99 > line.median;  // or only one
  const auto beside = [&](double us) { return many ? time_text(us) : std::string(); };
  return fmt::format("{:<46}{:>9}{:>9}{:>9}{:>9}{:>8}{:>14}\n", line.what, time_text(line.median),
                     beside(line.p99), beside(line.p999), beside(line.largest),
                     line.ratio ? fmt::format("{:.2f}", *line.ratio) : "",
                     line.instructions ? fmt::format("{:.0f}", *line.instructions)
                     : line.real_time  ? fmt::format("{:.0f} x life", *line.real_time)
                                       : "");
}

std::string text_of(const Report& report) {
  const Machine& m = report.machine;
  std::string text = fmt::format("limpid {}, {}\n{}, {} of them; {}; {}\nhaptic thread: {}\n\n{}",
                                 report.program, report.date, m.processor, m.processors, m.kernel,
                                 m.compiler, m.threads, table_head());
  for (const Line& line : report.lines) text += table_line(line);
  text +=
      "\nratio: of the medians, to the yardstick above, for meshes to the nearest point found by "
      "Embree. Medians "
      "and p99 are the\nprogram's; p99.9 and max are the machine's.\n";
  if (!m.counts) text += "Instructions cannot be counted here (perf_event_open).\n";
  if (report.share < 0.95) {
    text += fmt::format(
        "The machine was busy: this had {:.0f} % of a processor. Ratios hold, times do not.\n",
        100 * report.share);
  }
  return text;
}

std::string json_of(const Report& report) {
  nlohmann::ordered_json lines = nlohmann::ordered_json::array();
  for (const Line& line : report.lines) lines.push_back(json_of(line));
  const nlohmann::ordered_json all{{"limpid", report.program},
                                   {"date", report.date},
                                   {"machine", json_of(report.machine)},
                                   {"share", report.share},
                                   {"lines", lines}};
  return all.dump(2) + "\n";
}

}  // namespace limpid::bench
