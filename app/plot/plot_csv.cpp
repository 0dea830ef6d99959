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

PlotTable plot_table(const PlotSpec& spec, const History& history, double start, double stop) {
  PlotTable table;
  for (const Curve& curve : spec.curves) {
    if (curve.visible) table.columns.push_back(fmt::format("{} [{}]", curve.label, spec.unit));
  }
  const Rows rows = rows_between(history, start, stop);
  for (SampleIndex row = rows.from; row < rows.to; ++row) {
    table.times.push_back(history.time(row) - history.offset());
    for (const Curve& curve : spec.curves) {
      if (!curve.visible) continue;
      const auto value = static_cast<double>(history.value(curve.channel, row));
      table.values.push_back(spec.factor * value);
    }
  }
  return table;
}

std::size_t plot_table_rows(const History& history, double start, double stop) {
  const Rows rows = rows_between(history, start, stop);
  return static_cast<std::size_t>(rows.to - rows.from);
}

std::string csv_text(const PlotTable& table) {
  std::string text = "time [s]";
  for (const std::string& column : table.columns) text += "," + quoted(column);
  text += '\n';
  const auto out = std::back_inserter(text);
  auto value = table.values.begin();
  for (const double time : table.times) {
    fmt::format_to(out, "{:.6f}", time);
    for (std::size_t i = 0; i < table.columns.size(); ++i, ++value) {
      text += ',';
      if (std::isfinite(*value)) fmt::format_to(out, "{:.7g}", *value);
    }
    text += '\n';
  }
  return text;
}

}  // namespace limpid
