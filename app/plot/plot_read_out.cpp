#include <algorithm>
#include <cmath>

#include "app/plot/plot_frame.h"
#include "app/style/ticks.h"

namespace limpid {
namespace {

constexpr float kReach = 30;  // from the mouse to what it points at [px]

struct Line {
  std::string label;
  std::string value;
  Rgb rgb;
  ImVec2 at;  // on the screen
};

// As many digits as the screen can show, not as many as the number has.
std::string number_text(const PlotAxis& axis, const AxisMap& map, double value) {
  if (map.log) return three_digits(value * axis.factor);
  const double resolution = std::abs(axis.factor) * map.limits.span() / 1000;
  const int exponent = common_exponent(map.limits.low * axis.factor, map.limits.high * axis.factor);
  const double unit = std::pow(10.0, exponent);
  const std::string text = fixed_text(value * axis.factor / unit, decimals_of(resolution / unit));
  return exponent != 0 ? text + exponent_text(exponent) : text;
}

// Three digits, with the typographic minus.
std::string short_text(double value) {
  return (value < 0 ? "\u2212" : "") + three_digits(std::abs(value));
}

std::string value_text(const PlotAxis& axis, const AxisMap& map, double value) {
  return number_text(axis, map, value) + " " + axis.unit;
}

Rgb ink_of(const PlotFrame& frame, const Curve& curve) {
  return ink(frame.palette, curve.ink, curve.shade);
}

std::vector<Line> visible_lines(const PlotFrame& frame, const PlotSpec& spec,
                                const History& history, SampleIndex row) {
  std::vector<Line> lines;
  for (const Curve& curve : spec.curves) {
    if (!curve.visible) continue;
    const double value = history.value(curve.channel, row);
    if (!std::isfinite(value)) continue;
    std::string text = value_text(spec.y, frame.y, value);
    float x = frame.x_of(history.time(row));
    if (curve.across >= 0) {
      const double across = history.value(curve.across, row);
      if (!std::isfinite(across)) continue;
      x = frame.x_of(across);
      text += ", " + value_text(spec.x, frame.x, across);
    }
    lines.push_back({curve.label, std::move(text), ink_of(frame, curve), {x, frame.y_of(value)}});
  }
  return lines;
}

void draw_dots(const PlotFrame& frame, const std::vector<Line>& lines) {
  for (const Line& line : lines) {
    if (line.at.y < frame.area.min.y || line.at.y > frame.area.max.y) continue;
    if (line.at.x < frame.area.min.x || line.at.x > frame.area.max.x) continue;
    frame.list.AddCircleFilled(line.at, 4 * frame.scale, colour(frame.palette.panel));
    frame.list.AddCircleFilled(line.at, 2.8f * frame.scale, colour(line.rgb));
  }
}

void draw_line_at(const PlotFrame& frame, float x) {
  frame.list.AddRectFilled({x, frame.area.min.y}, {x + 1, frame.area.max.y},
                           colour(frame.palette.text, 0.45f));
}

void draw_box(const PlotFrame& frame, const std::string& title, const std::vector<Line>& lines,
              float line_x, ImVec2 near_to) {
  const float s = frame.scale;
  const float height = text_size(Face::small, "0").y + s;
  const float swatch = 10 * s;
  float labels = 0;
  float values = 0;
  for (const Line& line : lines) {
    labels = std::max(labels, text_size(Face::small, line.label).x);
    values = std::max(values, text_size(Face::small, line.value).x);
  }
  const float width =
      std::max(text_size(Face::small, title).x, swatch + 6 * s + labels + 12 * s + values) + 14 * s;
  const float tall = height * static_cast<float>(lines.size() + 1) + 10 * s;
  float left = line_x + 10 * s;
  if (left + width > frame.area.max.x) left = line_x - 10 * s - width;
  left = std::max(left, frame.outer.min.x);
  const float top = std::clamp(near_to.y - 0.5f * tall, frame.area.min.y,
                               std::max(frame.area.min.y, frame.area.max.y - tall));
  frame.list.AddRectFilled({left, top}, {left + width, top + tall},
                           colour(frame.palette.raised, 0.94f), 4 * s);
  frame.list.AddRect({left, top}, {left + width, top + tall}, colour(frame.palette.border), 4 * s);
  float y = top + 5 * s;
  draw_text(frame.list, Face::small, {left + 7 * s, y}, frame.palette.muted, title);
  for (const Line& line : lines) {
    y += height;
    const float middle = std::round(y + 0.5f * height);
    frame.list.AddRectFilled({left + 7 * s, middle - 1.5f * s},
                             {left + 7 * s + swatch, middle + 0.5f * s}, colour(line.rgb));
    draw_text(frame.list, Face::small, {left + 13 * s + swatch, y}, frame.palette.text, line.label);
    draw_text(frame.list, Face::small,
              {left + width - 7 * s - text_size(Face::small, line.value).x, y}, frame.palette.text,
              line.value);
  }
}

}  // namespace

void draw_read_out(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                   double time, ImVec2 near_to) {
  const bool over_time = spec.kind == PlotKind::time;
  const bool outside = time < frame.window.start() || time > frame.window.stop();
  if (outside || history.empty()) return;
  const SampleIndex row = history.nearest(time);
  const double distance = std::abs(history.time(row) - time);
  const bool in_gap = distance > std::max(1.5 * history.tick(), frame.window.per_pixel);
  std::vector<Line> lines = in_gap ? std::vector<Line>{} : visible_lines(frame, spec, history, row);
  float x = std::round(frame.x_of(time));
  if (over_time) {
    draw_line_at(frame, x);
    for (Line& line : lines) line.at.x = x + 0.5f;
  } else {
    if (lines.empty()) return;
    x = lines.front().at.x;
  }
  draw_dots(frame, lines);
  const double shown = (in_gap ? time : history.time(row)) - history.offset();
  const double step = std::max(history.tick(), frame.window.per_pixel / 10);
  std::string title = time_text(shown, step, std::abs(shown) >= 60);
  if (lines.empty()) title += "   no data";
  draw_box(frame, title, lines, x, near_to);
}

void draw_spectrum_read_out(const PlotFrame& frame, const PlotSpec& spec,
                            const std::vector<AmplitudeSpectrum>& spectra, double frequency,
                            ImVec2 near_to) {
  const float x = std::round(frame.x_of(frequency));
  if (x < frame.area.min.x || x > frame.area.max.x) return;
  // What the pixel shows: the highest of its frequencies, or the one that is nearest.
  const double low = frame.x_at(x - 0.5f), high = frame.x_at(x + 0.5f);
  std::vector<Line> lines;
  double at = frequency;
  for (std::size_t i = 0; i < spectra.size() && i < spec.curves.size(); ++i) {
    const AmplitudeSpectrum& s = spectra[i];
    if (!spec.curves[i].visible || s.amplitude.size() < 2) continue;
    const auto bin = [&](double f) {
      return std::clamp<std::size_t>(static_cast<std::size_t>(std::round(f / s.step)), 1,
                                     s.amplitude.size() - 1);
    };
    std::size_t best = bin(frequency);
    for (std::size_t k = bin(low); k <= bin(high); ++k) {
      if (s.amplitude[k] > s.amplitude[best]) best = k;
    }
    at = static_cast<double>(best) * s.step;
    lines.push_back({spec.curves[i].label,
                     value_text(spec.y, frame.y, s.amplitude[best]),
                     ink_of(frame, spec.curves[i]),
                     {x + 0.5f, frame.y_of(s.amplitude[best])}});
  }
  if (lines.empty()) return;
  draw_line_at(frame, x);
  draw_dots(frame, lines);
  draw_box(frame, three_digits(at) + " Hz", lines, x, near_to);
}

void draw_present(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                  double time) {
  if (history.empty()) return;
  draw_dots(frame, visible_lines(frame, spec, history, history.nearest(time)));
}

std::optional<double> time_near(const PlotFrame& frame, const PlotSpec& spec,
                                const History& history, ImVec2 mouse) {
  double nearest = std::pow(static_cast<double>(kReach * frame.scale), 2);
  std::optional<double> found;
  for (const Curve& curve : spec.curves) {
    if (!curve.visible) continue;
    const SampleIndex to = history.lower_bound(frame.window.stop());
    for (SampleIndex row = history.lower_bound(frame.window.start()); row < to; ++row) {
      const double x = frame.x_of(static_cast<double>(history.value(curve.across, row)));
      const double y = frame.y_of(static_cast<double>(history.value(curve.channel, row)));
      const double apart = std::pow(x - static_cast<double>(mouse.x), 2) +
                           std::pow(y - static_cast<double>(mouse.y), 2);
      if (apart >= nearest) continue;  // nor where one is not a number
      nearest = apart;
      found = history.time(row);
    }
  }
  return found;
}

namespace {

// Of sorted lines as many as there is room for: those go first that say what a neighbour says.
void leave_room(std::vector<Line>& lines, float most) {
  while (static_cast<float>(lines.size()) > most) {
    auto closest = lines.begin() + 1;
    for (auto line = closest; line != lines.end(); ++line) {
      const auto apart = [](auto at) { return at->at.y - (at - 1)->at.y; };
      if (apart(line) < apart(closest)) closest = line;
    }
    lines.erase(closest);
  }
}

}  // namespace

float end_label_width() { return text_size(Face::small, "\u22120.000").x + 6 * current_scale(); }

void draw_end_labels(const PlotFrame& frame, const PlotSpec& spec, const History& history) {
  const float room = frame.outer.max.x - frame.area.max.x;
  if (history.empty() || room < end_label_width()) return;
  const SampleIndex row = history.nearest(frame.window.stop());
  const int exponent =
      common_exponent(frame.y.low() * spec.y.factor, frame.y.high() * spec.y.factor);
  const float height = text_size(Face::small, "0").y;
  std::vector<Line> lines;
  for (const Curve& curve : spec.curves) {
    const auto value = static_cast<double>(history.value(curve.channel, row));
    if (!curve.visible || !std::isfinite(value)) continue;
    const bool nothing = std::abs(value) < 1e-6 * frame.y.limits.span();  // beside the others
    lines.push_back({"",
                     short_text(nothing ? 0 : value * spec.y.factor / std::pow(10.0, exponent)),
                     ink_of(frame, curve),
                     {0, frame.y_of(value)}});
  }
  std::ranges::sort(lines, {}, [](const Line& line) { return line.at.y; });
  leave_room(lines, std::max(1.0f, std::floor(frame.area.height() / height)));
  // From the top each stands below the one before, then from the bottom each above the next.
  float free = frame.area.min.y;
  for (Line& line : lines) {
    line.at.y = std::max(line.at.y - 0.5f * height, free);
    free = line.at.y + height;
  }
  free = frame.area.max.y;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    line->at.y = std::min(line->at.y, free - height);
    free = line->at.y;
  }
  for (const Line& line : lines) {
    draw_text(frame.list, Face::small, {frame.area.max.x + 5 * frame.scale, line.at.y}, line.rgb,
              line.value);
  }
}

}  // namespace limpid
