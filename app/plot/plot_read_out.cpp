#include <cmath>

#include "app/plot/plot_frame.h"
#include "app/style/ticks.h"

namespace limpid {
namespace {

struct Line {
  std::string label;
  std::string value;
  Rgb rgb;
  float value_y;  // on the screen
};

// As many digits as the screen can show, not as many as the number has.
std::string value_text(const PlotFrame& frame, const PlotSpec& spec, double value) {
  const double resolution = std::abs(spec.factor) * frame.y.span() / 1000;
  const int exponent = common_exponent(frame.y.low * spec.factor, frame.y.high * spec.factor);
  const double unit = std::pow(10.0, exponent);
  std::string text = fixed_text(value * spec.factor / unit, decimals_of(resolution / unit));
  if (exponent != 0) text += exponent_text(exponent);
  return text + " " + spec.unit;
}

std::vector<Line> visible_lines(const PlotFrame& frame, const PlotSpec& spec,
                                const History& history, SampleIndex row) {
  std::vector<Line> lines;
  for (const Curve& curve : spec.curves) {
    if (!curve.visible) continue;
    const double value = history.value(curve.channel, row);
    if (!std::isfinite(value)) continue;
    lines.push_back({curve.label, value_text(frame, spec, value),
                     ink(frame.palette, curve.ink, curve.shade), frame.y_of(value)});
  }
  return lines;
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
  const float x = frame.x_of(time);
  if (x < frame.area.min.x || x > frame.area.max.x || history.empty()) return;
  const float at = std::round(x);
  frame.list.AddRectFilled({at, frame.area.min.y}, {at + 1, frame.area.max.y},
                           colour(frame.palette.text, 0.45f));
  const SampleIndex row = history.nearest(time);
  const double distance = std::abs(history.time(row) - time);
  const bool in_gap = distance > std::max(1.5 * history.tick(), frame.window.per_pixel);
  const std::vector<Line> lines =
      in_gap ? std::vector<Line>{} : visible_lines(frame, spec, history, row);
  for (const Line& line : lines) {
    if (line.value_y < frame.area.min.y || line.value_y > frame.area.max.y) continue;
    frame.list.AddCircleFilled({at + 0.5f, line.value_y}, 4 * frame.scale,
                               colour(frame.palette.panel));
    frame.list.AddCircleFilled({at + 0.5f, line.value_y}, 2.8f * frame.scale, colour(line.rgb));
  }
  const double shown = (in_gap ? time : history.time(row)) - history.offset();
  const double step = std::max(history.tick(), frame.window.per_pixel / 10);
  std::string title = time_text(shown, step, std::abs(shown) >= 60);
  if (lines.empty()) title += "   no data";
  draw_box(frame, title, lines, x, near_to);
}

}  // namespace limpid
