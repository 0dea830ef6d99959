#include "app/plot/plot_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "app/base/markup.h"
#include "app/plot/axis.h"
#include "app/plot/band_names.h"
#include "app/plot/label_room.h"
#include "app/plot/plot_canvas.h"
#include "app/plot/shifted_canvas.h"
#include "app/plot/trace.h"
#include "app/run/provenance.h"
#include "app/style/ticks.h"
#include "core/base/utf8.h"

namespace limpid {

namespace {

std::string csv_cell(const std::string& text) {
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

// Makes a table over time or over another channel, whose column stands before the first curve that
// needs it.
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
    // A channel whose longest part has another length has other frequencies: it is left out.
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

using Point = PlotCanvas::Point;
using Area = PlotCanvas::Box;
using Anchor = PlotCanvas::Anchor;

constexpr double kLine = 2;        // width of a curve [px]
constexpr double kLabelLine = 14;  // height of a line of labels [px]
constexpr double kLabelBase = 11;  // of their base line below its top [px]
constexpr Rgb kPaper{255, 255, 255};
constexpr double kSvgSign = 3.6, kSvgBetween = 64, kSvgEdge = 3;  // as on the screen [px]
constexpr double kEdgeStep = kSvgEdge + 1;                        // from one edge to the next [px]
constexpr double kNameInset = 3, kNamesApart = 8;                 // of the names of bands [px]
constexpr double kBelow = 42;                      // room under the area, with a row of legend [px]
constexpr double kLeastArea = 40;                  // least height of the area [px]
constexpr double kLegendFont = 0.6 * kCanvasFont;  // width of a character in the legend [px]
constexpr double kEntrySample = 23, kEntryGap = 17;  // in the legend [px]
constexpr int kColumnsPerPixel = 2;                  // as pictures are looked at closely

std::string hex(Rgb c) { return fmt::format("#{:02x}{:02x}{:02x}", c.r, c.g, c.b); }

Rgb paper_of(const Palette& palette) { return palette.dark ? palette.panel : kPaper; }

class SvgCanvas : public PlotCanvas {
 public:
  // `height` is that of the document, which may be of several pictures.
  SvgCanvas(const PlotPicture& picture, double height, const Palette& palette) {
    const std::string unit = picture.millimetres > 0 ? "mm" : "";
    const double size = picture.millimetres > 0 ? picture.millimetres / picture.width : 1;
    add("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}{6}\" height=\"{1:g}{6}\" "
        "viewBox=\"0 0 {2} {3}\" font-family=\"Inter, Helvetica, Arial, sans-serif\" "
        "font-size=\"{4}\">\n<rect width=\"100%\" height=\"100%\" fill=\"{5}\"/>\n",
        size * picture.width, size * height, picture.width, height, kCanvasFont,
        hex(paper_of(palette)), unit);
    add("<pattern id=\"stripes\" width=\"7\" height=\"7\" patternUnits=\"userSpaceOnUse\" "
        "patternTransform=\"rotate(45)\"><rect width=\"7\" height=\"7\" fill=\"{0}\" "
        "fill-opacity=\"0.1\"/><line x1=\"0\" y1=\"0\" x2=\"0\" y2=\"7\" stroke=\"{0}\" "
        "stroke-opacity=\"0.5\"/></pattern>\n",
        hex(palette.muted));
  }

  std::string end() { return text_ + "</svg>\n"; }

  void rect(const Area& box, Rgb fill, double alpha) override {
    at(box);
    add("fill=\"{}\" fill-opacity=\"{:.3f}\"/>\n", hex(fill), alpha);
  }
  void outline(const Area& box, Rgb rgb) override {
    at(box);
    add("fill=\"none\" stroke=\"{}\"/>\n", hex(rgb));
  }
  void stripes(const Area& box, Rgb) override {
    at(box);
    add("fill=\"url(#stripes)\"/>\n");
  }
  void line(Point from, Point to, Rgb rgb, double width, double dash, double gap) override {
    add("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
        "stroke-width=\"{:g}\" stroke-dasharray=\"{}\"/>\n",
        from.x, from.y, to.x, to.y, hex(rgb), width,
        dash > 0 ? fmt::format("{:g} {:g}", dash, gap) : "none");
  }
  void polyline(std::span<const Point> points, Rgb rgb, double width) override {
    add("<polyline fill=\"none\" ");
    edged(points, rgb, width);
  }
  void polygon(std::span<const Point> points, Rgb rgb, double width) override {
    add("<polygon fill=\"{}\" ", hex(rgb));
    edged(points, rgb, width);
  }
  void square(Point middle, double half, Rgb fill, Rgb edge) override {
    at({middle.x - half, middle.y - half, 2 * half, 2 * half});
    add("fill=\"{}\" stroke=\"{}\"/>\n", hex(fill), hex(edge));
  }
  void ring(Point middle, double radius, Rgb edge, Rgb fill) override {
    add("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\" fill=\"{}\" stroke=\"{}\" "
        "stroke-width=\"1.8\"/>\n",
        middle.x, middle.y, radius, hex(fill), hex(edge));
  }
  void text(Point at, Anchor anchor, Rgb rgb, const std::string& what, bool bold) override {
    constexpr std::array kAnchors{"start", "middle", "end"};
    add("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\" "
        "font-weight=\"{}\">{}</text>\n",
        at.x, at.y, kAnchors[static_cast<std::size_t>(anchor)], hex(rgb), bold ? 600 : 400,
        escaped(what));
  }
  void clip(const Area* box) override {
    if (box == nullptr) return add("</g>\n");
    ++areas_;
    add("<clipPath id=\"area{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n"
        "<g clip-path=\"url(#area{})\">\n",
        areas_, box->left, box->top, box->width, box->height, areas_);
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
  }
  void at(const Area& box) {
    add("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" ", box.left, box.top,
        box.width, box.height);
  }
  void edged(std::span<const Point> points, Rgb rgb, double width) {
    add("stroke=\"{}\" stroke-width=\"{:g}\" stroke-linejoin=\"round\" points=\"", hex(rgb), width);
    for (const Point& p : points) add("{:.2f},{:.2f} ", p.x, p.y);
    add("\"/>\n");
  }

  std::string text_;
  int areas_ = 0;
};

// Returns the text, with an ellipsis at its end if it is wider than `width` in the legend.
std::string with_ellipsis(const std::string& text, double width) {
  const auto most = static_cast<std::size_t>(std::max(1.0, width / kLegendFont));
  if (count_characters(text) <= most) return text;
  std::size_t characters = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = (static_cast<unsigned char>(text[i]) & 0xc0) != 0x80;
    if (begins && ++characters == most) return text.substr(0, i) + "\u2026";
  }
  return text;
}

// Draws the picture of a plot on any canvas.
class PlotDrawing {
 public:
  PlotDrawing(const PlotSpec& spec, const History& history, const PlotPicture& picture)
      : spec_(spec),
        history_(history),
        picture_(picture),
        palette_(palette(picture.theme)),
        right_(picture.width - 14.0),
        bottom_(picture.height - kBelow) {
    lay_out_legend();
    room_ = LabelRoom(area());
  }

  Area area() const { return {left_, top_, right_ - left_, bottom_ - top_}; }
  const Palette& colours() const { return palette_; }

  void draw(PlotCanvas& canvas) {
    canvas_ = &canvas;
    label(left_, 20, Anchor::start, palette_.text,
          spec_.title + "  [" + unit_text(spec_.y, picture_.y) + "]", true);
    spec_.kind == PlotKind::time ? time_axis() : across_axis();
    value_axis();
    const Area inside = area();
    canvas.clip(&inside);
    see_columns();
    if (spec_.kind == PlotKind::time) {
      bands();
      mark_lines();
    }
    curves();
    thresholds();
    if (spec_.kind == PlotKind::time) mark_labels();
    canvas.clip(nullptr);
    canvas.outline(inside, palette_.axis);
    legend();
  }

 private:
  static double width_of(const std::string& text, double font = 0.55 * kCanvasFont) {
    return font * static_cast<double>(count_characters(text));
  }
  void label(double x, double y, Anchor anchor, Rgb rgb, const std::string& what,
             bool bold = false) {
    canvas_->text({x, y}, anchor, rgb, what, bold);
  }

  // Draws a label in the box that it took, from its left end or up to its right one: widths are
  // estimates.
  void put(const Area& box, Anchor anchor, Rgb rgb, const std::string& what) {
    const double x = anchor == Anchor::end ? box.left + box.width : box.left;
    label(x, box.top + kLabelBase, anchor, rgb, what);
  }

  void line(double x1, double y1, double x2, double y2, Rgb rgb, double dash = 0, double gap = 0) {
    canvas_->line({x1, y1}, {x2, y2}, rgb, 1, dash, gap);
  }

  double x_of(double time) const {
    return x_at((time - picture_.start) / (picture_.stop - picture_.start));
  }
  double x_at(double part) const { return std::clamp(left_ + part * (right_ - left_), -1e4, 1e4); }
  double y_of(double value) const {
    return std::clamp(bottom_ - picture_.y.part(value) * (bottom_ - top_), -1e4, 1e4);
  }

  void time_axis() {
    const double offset = history_.offset();
    const double low = picture_.start - offset;
    const double high = picture_.stop - offset;
    const bool clock = std::max(std::abs(low), std::abs(high)) >= 60;
    const Ticks ticks = time_ticks(low, high, picture_.width / 90);
    for (std::int64_t i = ticks.first; i <= ticks.last; ++i) {
      const double x = x_of(ticks.at(i) + offset);
      line(x, top_, x, bottom_, palette_.grid);
      label(x, bottom_ + 16, Anchor::middle, palette_.muted,
            time_text(ticks.at(i), ticks.step, clock));
    }
  }

  void across_axis() {
    for (const AxisPlace& place : axis_places(spec_.x, picture_.x, picture_.width / 90.0)) {
      const double x = x_at(picture_.x.part(place.value));
      line(x, top_, x, bottom_, palette_.grid);
      label(x, bottom_ + 16, Anchor::middle, palette_.muted, place.label);
    }
    label(right_, picture_.height - 10, Anchor::end, palette_.text, across_name());
  }
  std::string across_name() const {
    return spec_.x.label + "  [" + unit_text(spec_.x, picture_.x) + "]";
  }

  void value_axis() {
    for (const AxisPlace& place : axis_places(spec_.y, picture_.y, (bottom_ + kBelow) / 45)) {
      const double y = y_of(place.value);
      line(left_, y, right_, y, palette_.grid);
      label(left_ - 6, y + 4, Anchor::end, palette_.muted, place.label);
    }
    if (spec_.y.zero_line && !picture_.y.log) {
      line(left_, y_of(0), right_, y_of(0), palette_.axis);
    }
  }

  // Calls draw(mark, x, rgb) for the marks in sight, from the left.
  template <class Draw>
  void for_marks(Draw&& draw) {
    for (const PlotMark& mark : history_.marks()) {
      if (mark.time < picture_.start || mark.time > picture_.stop) continue;
      draw(mark, x_of(mark.time), mark.key == kNoteMark ? palette_.text : palette_.muted);
    }
  }

  void mark_lines() {
    for_marks([&](const PlotMark& mark, double x, Rgb rgb) {
      line(x, top_, x, bottom_, rgb, mark.key == kNoteMark ? 0 : 2, 3);
    });
  }

  // Labels marks in rows from the bottom up; those that a band says and those without room have no
  // label.
  void mark_labels() {
    const std::vector<std::string> said = said_by_bands(spec_.bands, history_, rows_);
    for_marks([&](const PlotMark& mark, double x, Rgb rgb) {
      if (std::ranges::find(said, mark.key) != said.end()) return;
      const double wide = width_of(mark.label);
      const Anchor anchor = x + 4 + wide > right_ ? Anchor::end : Anchor::start;
      const double left = anchor == Anchor::end ? x - 4 - wide : x + 4;
      std::array<Area, 4> rows;
      for (std::size_t row = 0; row < rows.size(); ++row) {
        rows[row] = {left, bottom_ - 2 - kLabelLine * static_cast<double>(row + 1), wide,
                     kLabelLine};
      }
      if (const auto box = room_.take_first(rows)) put(*box, anchor, rgb, mark.label);
    });
  }

  void thresholds() {
    for (const Threshold& each : spec_.thresholds) {
      const Rgb rgb = ink(palette_, each.ink);
      const double y = y_of(each.value);
      line(left_, y, right_, y, rgb, 4, 3);
      const auto box = room_.take_first(room_.beside_level(y, width_of(each.label), kLabelLine, 6));
      if (!box) continue;
      const bool left_half = box->left + box->width < (left_ + right_) / 2;
      put(*box, left_half ? Anchor::start : Anchor::end, rgb, each.label);
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
    double base = top_ + 15 + kEdgeStep * (law_edges(spec_.bands) - 1);  // of the names
    for (const Band& each : spec_.bands) {
      std::vector<NamedStretch> named;
      for (const BandStretch& stretch : band_stretches(each, history_, rows_)) {
        const double left = column(static_cast<double>(stretch.from));
        const double right = column(static_cast<double>(stretch.to));
        stretch_of(each, stretch.said, left, right - left);
        const std::string& name = each.names[static_cast<std::size_t>(stretch.said)];
        named.push_back(
            {stretch.said, left, right, name.empty() ? 0 : kNameInset + width_of(name)});
      }
      // A short time under another law is a line without a name.
      const auto placed = place_names(named, {left_, right_, kNamesApart, !each.laws});
      for (const PlacedName& place : placed) {
        const NamedStretch& of = named[place.stretch];
        const double x = place.left + kNameInset;
        label(x, base, Anchor::start, palette_.text, each.names[static_cast<std::size_t>(of.said)]);
        room_.take({x, base - kLabelBase, of.width - kNameInset + kNamesApart, kLabelLine});
      }
      base += placed.empty() ? 0 : kLabelLine;  // each band with names has a line
    }
  }

  // Draws a stretch in which the band says this.
  void stretch_of(const Band& band, int said, double left, double width) {
    if (said == 0 && !band.laws) return;
    const Area box{left, top_, width, bottom_ - top_};
    const auto tint = static_cast<double>(band.tint);
    const auto most = static_cast<double>(std::max<std::size_t>(2, band.names.size()) - 1);
    if (band.laws) {
      const Rgb law = law_ink(palette_, said);
      if (band.lane < 0) canvas_->rect(box, law, tint);
      const double edge = top_ + kEdgeStep * std::max(0, band.lane);
      canvas_->rect({left, edge, width, kSvgEdge}, law, 1);
    } else if (band.striped) {
      canvas_->stripes(box, palette_.muted);
    } else {
      canvas_->rect(box, palette_.accent, tint * said / most);
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
        const Rgb rgb = colour_of(palette_, curve, run.law);
        trace.band ? band(points, rgb) : polyline(points, rgb);
        if (spec_.kind == PlotKind::time) signs(points, curve.sign, rgb);
      }
    }
  }

  Point point(const TracePoint& p, float value) const {
    return {x_at((static_cast<double>(p.x) - first_column_) / columns_),
            y_of(static_cast<double>(value))};
  }

  // Fills the outline of the band; its stroke gives thin bands the width of a line.
  void band(std::span<const TracePoint> points, Rgb rgb) {
    std::vector<Point> outline;
    for (const TracePoint& p : points) outline.push_back(point(p, p.high));
    for (auto p = points.rbegin(); p != points.rend(); ++p) outline.push_back(point(*p, p->low));
    canvas_->polygon(outline, rgb, kLine);
  }

  void sign(double x, double y, RunSign sign, Rgb rgb) {
    const Rgb back = paper_of(palette_);
    if (sign == RunSign::square) canvas_->square({x, y}, kSvgSign, rgb, back);
    if (sign == RunSign::ring) canvas_->ring({x, y}, kSvgSign, rgb, back);
    if (sign != RunSign::triangle) return;
    const auto triangle = [&](double r, Rgb fill) {
      const std::array<Point, 3> corners{{{x, y - r}, {x + r, y + 0.8 * r}, {x - r, y + 0.8 * r}}};
      canvas_->polygon(corners, fill, 0);
    };
    triangle(kSvgSign + 2, back);
    triangle(kSvgSign, rgb);
  }

  void signs(std::span<const TracePoint> points, RunSign each, Rgb rgb) {
    double next = left_ + kSvgBetween / 2;
    for (const TracePoint& p : points) {
      const double x = x_at((static_cast<double>(p.x) - first_column_) / columns_);
      if (x < next) continue;
      sign(x, y_of(0.5 * static_cast<double>(p.low + p.high)), each, rgb);
      next = kSvgBetween * std::ceil((x - left_) / kSvgBetween + 0.5) + left_ - kSvgBetween / 2;
    }
  }

  void polyline(std::span<const TracePoint> points, Rgb rgb) {
    std::vector<Point> line;
    for (const TracePoint& p : points) line.push_back(point(p, p.low));
    canvas_->polyline(line, rgb, kLine);
  }

  struct Entry {
    const Curve* curve;  // null: words about those without room
    std::string label;
    double left;
    int row;
  };

  // Lays out the legend in as many rows as it needs, and takes them from the curves' area. Entries
  // without room are counted in the last row.
  void lay_out_legend() {
    double x = left_;
    int row = 0;
    for (const Curve& curve : spec_.curves) {
      if (!curve.visible) continue;
      const std::string label = with_ellipsis(curve.name(), right_ - left_ - kEntrySample);
      const double wide = kEntrySample + width_of(label, kLegendFont);
      if (x > left_ && x + wide > right_) {
        x = left_;
        ++row;
      }
      entries_.push_back({&curve, label, x, row});
      x += wide + kEntryGap;
    }
    // The horizontal axis' name stands at the end of the last row, or has one of its own.
    const bool named = spec_.kind != PlotKind::time && !entries_.empty();
    if (named && x > right_ - width_of(across_name(), kLegendFont)) ++row;
    const int most = std::max(0, static_cast<int>((bottom_ - top_ - kLeastArea) / kLabelLine));
    if (row > most) {
      row = most;
      const auto left_out = std::erase_if(entries_, [&](const Entry& e) { return e.row >= most; });
      entries_.push_back({nullptr, fmt::format("and {} more", left_out), left_, most});
    }
    last_row_ = row;
    bottom_ -= kLabelLine * row;
  }

  void legend() {
    for (const Entry& e : entries_) {
      const double y = picture_.height - 10 - kLabelLine * (last_row_ - e.row);
      if (e.curve == nullptr) {
        label(e.left, y, Anchor::start, palette_.muted, e.label);
        continue;
      }
      const Rgb rgb = colour_of(palette_, *e.curve);
      canvas_->line({e.left, y - 4}, {e.left + 18, y - 4}, rgb, kLine, 0, 0);
      sign(e.left + 9, y - 4, e.curve->sign, rgb);
      label(e.left + kEntrySample, y, Anchor::start, palette_.text, e.label);
    }
  }

  const PlotSpec& spec_;
  const History& history_;
  const PlotPicture& picture_;
  const Palette& palette_;
  double left_ = 56;
  double top_ = 32;
  double right_;
  double bottom_;
  std::vector<Entry> entries_;  // of the legend, whose rows count from 0
  int last_row_ = 0;
  int columns_ = 1;          // of the traces, over the area's width
  double first_column_ = 0;  // column at the area's left end
  PixelWindow window_{};
  std::vector<SampleIndex> rows_;  // of the columns
  PlotCanvas* canvas_ = nullptr;
  LabelRoom room_{area()};
};

}  // namespace

PlotTable plot_table(const PlotSpec& spec, const History& history, double start, double stop) {
  if (spec.kind == PlotKind::spectrum) return spectrum_table(spec, history, start, stop);
  return rows_table(spec, history, rows_between(history, start, stop));
}

std::string csv_text(const PlotTable& table) {
  std::string text = table.first;
  for (const std::string& column : table.columns) text += "," + csv_cell(column);
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

std::string word_on_times(const PlotTable& table) {
  if (table.times.empty() || table.times.front() >= 0) return "";
  return " (negative times: before the last t = 0)";
}

std::string figure_svg(std::span<const FigurePart> parts, const History& history) {
  const PlotPicture& first = parts.front().picture;
  const double height = static_cast<double>(parts.size()) * first.height;
  SvgCanvas canvas(first, height, palette(first.theme));
  draw_figure(parts, history, canvas);
  // Provenance names no settings, as they may have changed within the plot's time.
  return with_metadata(canvas.end(), provenance("", std::nullopt));
}

std::string plot_svg(const PlotSpec& spec, const History& history, const PlotPicture& picture) {
  const FigurePart one{spec, picture};
  return figure_svg(std::span(&one, 1), history);
}

Rgb paper_of(const PlotPicture& picture) { return paper_of(palette(picture.theme)); }

void draw_figure(std::span<const FigurePart> parts, const History& history, PlotCanvas& canvas) {
  double down = 0;
  for (const FigurePart& part : parts) {
    ShiftedCanvas below(canvas, down);
    draw_plot(part.spec, history, part.picture, below);
    down += part.picture.height;
  }
}

void draw_plot(const PlotSpec& spec, const History& history, const PlotPicture& picture,
               PlotCanvas& canvas) {
  PlotDrawing(spec, history, picture).draw(canvas);
}

Raster plot_raster(const PlotSpec& spec, const History& history, const PlotPicture& picture,
                   double scale) {
  RasterCanvas canvas(picture.width, picture.height, scale, paper_of(picture));
  draw_plot(spec, history, picture, canvas);
  return canvas.take();
}

}  // namespace limpid
