#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "app/plot/plot_export.h"

namespace limpid {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

struct Rows {
  SampleIndex from;
  SampleIndex to;
};

Rows rows_between(const History& history, double start, double stop) {
  const SampleIndex from = history.lower_bound(start);
  SampleIndex to = history.lower_bound(stop, from);
  if (to < history.end() && history.time(to) == stop) ++to;
  return {from, to};
}

}  // namespace

std::size_t plot_csv_rows(const History& history, double start, double stop) {
  const Rows rows = rows_between(history, start, stop);
  return static_cast<std::size_t>(rows.to - rows.from);
}

std::string plot_csv(const PlotSpec& spec, const History& history, double start, double stop) {
  std::string text = "time [s]";
  for (const Curve& curve : spec.curves) {
    if (curve.visible) text += "," + quoted(fmt::format("{} [{}]", curve.label, spec.unit));
  }
  text += '\n';
  const auto out = std::back_inserter(text);
  const Rows rows = rows_between(history, start, stop);
  for (SampleIndex row = rows.from; row < rows.to; ++row) {
    fmt::format_to(out, "{:.6f}", history.time(row) - history.offset());
    for (const Curve& curve : spec.curves) {
      if (!curve.visible) continue;
      const double value = spec.factor * static_cast<double>(history.value(curve.channel, row));
      text += ',';
      if (std::isfinite(value)) fmt::format_to(out, "{:.7g}", value);
    }
    text += '\n';
  }
  return text;
}

}  // namespace limpid
