#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "app/plot/plot_export.h"
#include "app/plot/trace.h"

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

// Over time, or over another channel: that one's column stands before the first curve that needs
// it.
PlotTable rows_table(const PlotSpec& spec, const History& history, Rows rows) {
  PlotTable table;
  std::vector<std::pair<int, double>> columns;  // channel, factor
  int across = -1;
  for (const Curve& curve : spec.curves) {
    if (!curve.visible) continue;
    if (curve.across != across) {
      across = curve.across;
      const std::string whose = columns.empty() ? "" : fmt::format(" ({})", curve.label);
      table.columns.push_back(fmt::format("{}{} [{}]", spec.x.label, whose, spec.x.unit));
      columns.emplace_back(across, spec.x.factor);
    }
    table.columns.push_back(fmt::format("{} [{}]", curve.label, spec.y.unit));
    columns.emplace_back(curve.channel, spec.y.factor);
  }
  for (SampleIndex row = rows.from; row < rows.to; ++row) {
    table.times.push_back(history.time(row) - history.offset());
    for (const auto& [channel, factor] : columns) {
      table.values.push_back(factor * static_cast<double>(history.value(channel, row)));
    }
  }
  return table;
}

PlotTable spectrum_table(const PlotSpec& spec, const History& history, double start, double stop) {
  PlotTable table;
  table.first = "frequency [Hz]";
  std::vector<AmplitudeSpectrum> spectra;
  for (const Curve& curve : spec.curves) {
    if (!curve.visible) continue;
    AmplitudeSpectrum s = spectrum_between(history, curve.channel, start, stop);
    // Where a channel's longest part is another one, its frequencies are.
    if (s.empty() || (!spectra.empty() && s.step != spectra.front().step)) continue;
    spectra.push_back(std::move(s));
    table.columns.push_back(fmt::format("{} [{}]", curve.label, spec.y.unit));
  }
  if (spectra.empty()) return table;
  for (std::size_t i = 0; i < spectra.front().amplitude.size(); ++i) {
    table.times.push_back(static_cast<double>(i) * spectra.front().step);
    for (const auto& s : spectra) table.values.push_back(spec.y.factor * s.amplitude[i]);
  }
  return table;
}

}  // namespace

PlotTable plot_table(const PlotSpec& spec, const History& history, double start, double stop) {
  if (spec.kind == PlotKind::spectrum) return spectrum_table(spec, history, start, stop);
  return rows_table(spec, history, rows_between(history, start, stop));
}

std::string csv_text(const PlotTable& table) {
  std::string text = table.first;
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
