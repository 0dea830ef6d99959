#include "app/plot/plot_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "app/base/markup.h"
#include "app/plot/axis.h"
#include "app/plot/trace.h"
#include "app/style/ticks.h"

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

namespace {

constexpr double kFont = 12;         // [px]
constexpr double kLine = 2;          // [px]
constexpr int kColumnsPerPixel = 2;  // pictures are looked at closely

std::string hex(Rgb c) { return fmt::format("#{:02x}{:02x}{:02x}", c.r, c.g, c.b); }

class SvgPlot {
 public:
  SvgPlot(const PlotSpec& spec, const History& history, const PlotPicture& picture)
      : spec_(spec),
        history_(history),
        picture_(picture),
        right_(picture.width - 14.0),
        bottom_(picture.height - 42.0) {}

  std::string write() {
    open();
    spec_.kind == PlotKind::time ? time_axis() : across_axis();
    value_axis();
    add("<g clip-path=\"url(#area)\">\n");
    see_columns();
    if (spec_.kind == PlotKind::time) {
      bands();
      marks();
    }
    curves();
    thresholds();
    add("</g>\n");
    add("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"{}\"/>\n", left_,
        top_, right_ - left_, bottom_ - top_, hex(kLightPalette.axis));
    legend();
    return text_ + "</svg>\n";
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
  }

  void label(double x, double y, const char* anchor, Rgb rgb, const std::string& what,
             const char* weight = "400") {
    add("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\" "
        "font-weight=\"{}\">{}</text>\n",
        x, y, anchor, hex(rgb), weight, escaped(what));
  }

  void line(double x1, double y1, double x2, double y2, Rgb rgb, const char* dash = "none") {
    add("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
        "stroke-dasharray=\"{}\"/>\n",
        x1, y1, x2, y2, hex(rgb), dash);
  }

  double x_of(double time) const {
    return x_at((time - picture_.start) / (picture_.stop - picture_.start));
  }
  double x_at(double part) const { return std::clamp(left_ + part * (right_ - left_), -1e4, 1e4); }
  double y_of(double value) const {
    return std::clamp(bottom_ - picture_.y.part(value) * (bottom_ - top_), -1e4, 1e4);
  }

  void open() {
    add("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
        "viewBox=\"0 0 {0} {1}\" font-family=\"Inter, Helvetica, Arial, sans-serif\" "
        "font-size=\"{2}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        picture_.width, picture_.height, kFont);
    add("<clipPath id=\"area\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n",
        left_, top_, right_ - left_, bottom_ - top_);
    add("<pattern id=\"stripes\" width=\"7\" height=\"7\" patternUnits=\"userSpaceOnUse\" "
        "patternTransform=\"rotate(45)\"><rect width=\"7\" height=\"7\" fill=\"{0}\" "
        "fill-opacity=\"0.1\"/><line x1=\"0\" y1=\"0\" x2=\"0\" y2=\"7\" stroke=\"{0}\" "
        "stroke-opacity=\"0.5\"/></pattern>\n",
        hex(kLightPalette.muted));
    label(left_, 20, "start", kLightPalette.text,
          spec_.title + "  [" + unit_text(spec_.y, picture_.y) + "]", "600");
  }

  void time_axis() {
    const double offset = history_.offset();
    const double low = picture_.start - offset;
    const double high = picture_.stop - offset;
    const bool clock = std::max(std::abs(low), std::abs(high)) >= 60;
    const Ticks ticks = time_ticks(low, high, picture_.width / 90);
    for (std::int64_t i = ticks.first; i <= ticks.last; ++i) {
      const double x = x_of(ticks.at(i) + offset);
      line(x, top_, x, bottom_, kLightPalette.grid);
      label(x, bottom_ + 16, "middle", kLightPalette.muted,
            time_text(ticks.at(i), ticks.step, clock));
    }
  }

  void across_axis() {
    for (const AxisPlace& place : axis_places(spec_.x, picture_.x, picture_.width / 90.0)) {
      const double x = x_at(picture_.x.part(place.value));
      line(x, top_, x, bottom_, kLightPalette.grid);
      label(x, bottom_ + 16, "middle", kLightPalette.muted, place.label);
    }
    label(right_, picture_.height - 10, "end", kLightPalette.text,
          spec_.x.label + "  [" + unit_text(spec_.x, picture_.x) + "]");
  }

  void value_axis() {
    for (const AxisPlace& place : axis_places(spec_.y, picture_.y, picture_.height / 45.0)) {
      const double y = y_of(place.value);
      line(left_, y, right_, y, kLightPalette.grid);
      label(left_ - 6, y + 4, "end", kLightPalette.muted, place.label);
    }
    if (spec_.y.zero_line && !picture_.y.log) {
      line(left_, y_of(0), right_, y_of(0), kLightPalette.axis);
    }
  }

  void marks() {
    for (const Mark& mark : history_.marks()) {
      if (mark.time < picture_.start || mark.time > picture_.stop) continue;
      line(x_of(mark.time), top_, x_of(mark.time), bottom_, kLightPalette.muted, "2 3");
      label(x_of(mark.time) + 4, bottom_ - 5, "start", kLightPalette.muted, mark.label);
    }
  }

  void thresholds() {
    for (const Threshold& each : spec_.thresholds) {
      const Rgb rgb = ink(kLightPalette, each.ink);
      line(left_, y_of(each.value), right_, y_of(each.value), rgb, "4 3");
      label(right_ - 6, y_of(each.value) - 4, "end", rgb, each.label);
    }
  }

  void see_columns() {
    columns_ = kColumnsPerPixel * static_cast<int>(right_ - left_);
    const double per_column = (picture_.stop - picture_.start) / columns_;
    window_ = {per_column, static_cast<std::int64_t>(std::floor(picture_.start / per_column)),
               columns_ + 1};
    pixel_rows(history_, window_, rows_);
    if (spec_.kind != PlotKind::time) return;
    first_column_ = picture_.start / per_column - static_cast<double>(window_.first_pixel);
  }
  double column(double number) const { return x_at((number - first_column_) / columns_); }

  void bands() {
    for (const Band& each : spec_.bands) {
      const auto most = static_cast<double>(std::max<std::size_t>(2, each.names.size()) - 1);
      int before = -1;
      for (const BandStretch& stretch : band_stretches(each, history_, rows_)) {
        const bool named = std::exchange(before, stretch.said) != stretch.said;
        if (stretch.said == 0) continue;
        const double left = column(static_cast<double>(stretch.from));
        add("<rect x=\"{:.2f}\" y=\"{}\" width=\"{:.2f}\" height=\"{}\" ", left, top_,
            column(static_cast<double>(stretch.to)) - left, bottom_ - top_);
        if (each.striped) {
          add("fill=\"url(#stripes)\"/>\n");
        } else {
          add("fill=\"{}\" fill-opacity=\"{:.3f}\"/>\n", hex(kLightPalette.accent),
              static_cast<double>(each.tint) * stretch.said / most);
        }
        if (!named) continue;
        label(std::max(left, left_) + 3, top_ + (each.striped ? 26 : 13), "start",
              kLightPalette.text, each.names[static_cast<std::size_t>(stretch.said)]);
      }
    }
  }

  void curves() {
    const TraceArea area{picture_.x, picture_.y, columns_,
                         kColumnsPerPixel * static_cast<int>(bottom_ - top_)};
    Trace trace;
    for (const Curve& curve : spec_.curves) {
      if (!curve.visible) continue;
      switch (spec_.kind) {
        case PlotKind::time: make_trace(history_, curve, window_, rows_, trace); break;
        case PlotKind::cross:
          make_cross_trace(history_, curve, rows_.front(), rows_.back(), area, trace);
          break;
        case PlotKind::spectrum:
          make_spectrum_trace(
              spectrum_between(history_, curve.channel, picture_.start, picture_.stop), area,
              trace);
          break;
      }
      for (const TraceRun& run : trace.runs) {
        const auto points = std::span(trace.points).subspan(run.first, run.count);
        const Rgb rgb = ink(kLightPalette, curve.ink, curve.shade);
        trace.band ? band(points, rgb) : polyline(points, rgb);
      }
    }
  }

  void point(const TracePoint& p, float value) {
    add("{:.2f},{:.2f} ", x_at((static_cast<double>(p.x) - first_column_) / columns_),
        y_of(static_cast<double>(value)));
  }

  // The outline of the band, filled; its stroke gives thin bands the width of a line.
  void band(std::span<const TracePoint> points, Rgb rgb) {
    add("<polygon fill=\"{0}\" stroke=\"{0}\" stroke-width=\"{1}\" stroke-linejoin=\"round\" "
        "points=\"",
        hex(rgb), kLine);
    for (const TracePoint& p : points) point(p, p.high);
    for (auto p = points.rbegin(); p != points.rend(); ++p) point(*p, p->low);
    add("\"/>\n");
  }

  void polyline(std::span<const TracePoint> points, Rgb rgb) {
    add("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\" "
        "points=\"",
        hex(rgb), kLine);
    for (const TracePoint& p : points) point(p, p.low);
    add("\"/>\n");
  }

  void legend() {
    double x = left_;
    for (const Curve& curve : spec_.curves) {
      if (!curve.visible) continue;
      const double y = picture_.height - 10;
      add("<line x1=\"{:.1f}\" y1=\"{}\" x2=\"{:.1f}\" y2=\"{}\" stroke=\"{}\" "
          "stroke-width=\"2\"/>\n",
          x, y - 4, x + 18, y - 4, hex(ink(kLightPalette, curve.ink, curve.shade)));
      label(x + 23, y, "start", kLightPalette.text, curve.label);
      x += 40 + 0.6 * kFont * static_cast<double>(curve.label.size());
    }
  }

  const PlotSpec& spec_;
  const History& history_;
  const PlotPicture& picture_;
  double left_ = 56;
  double top_ = 32;
  double right_;
  double bottom_;
  int columns_ = 1;          // of the traces, over the area's width
  double first_column_ = 0;  // that stands at its left end
  PixelWindow window_{};
  std::vector<SampleIndex> rows_;  // of the columns
  std::string text_;
};

}  // namespace

std::string plot_svg(const PlotSpec& spec, const History& history, const PlotPicture& picture) {
  return SvgPlot(spec, history, picture).write();
}

}  // namespace limpid
