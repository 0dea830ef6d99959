// Grid and labels of a plot's axes.
#include <algorithm>
#include <cmath>

#include "app/plot/axis_places.h"
#include "app/plot/plot_frame.h"
#include "app/style/ticks.h"

namespace limpid {
namespace {

void level_line(const PlotFrame& frame, float y, ImU32 rgba, float thickness = 1) {
  const float at = std::round(y);
  frame.list.AddRectFilled({frame.area.min.x, at}, {frame.area.max.x, at + thickness}, rgba);
}

void upright_line(const PlotFrame& frame, float x, ImU32 rgba, float thickness = 1) {
  const float at = std::round(x);
  frame.list.AddRectFilled({at, frame.area.min.y}, {at + thickness, frame.area.max.y}, rgba);
}

void draw_value_axis(const PlotFrame& frame, const PlotSpec& spec) {
  const float text_height = text_size(Face::small, "0").y;
  const auto most = static_cast<double>(frame.area.height() / (2.0f * text_height));
  for (const AxisPlace& place : axis_places(spec.y, frame.y, most)) {
    const float y = frame.y_of(place.value);
    level_line(frame, y, colour(frame.palette.grid));
    const ImVec2 size = text_size(Face::small, place.label);
    // Pushed inwards at the ends rather than cut off or left out.
    const float middle = y - 0.5f * size.y;
    const float top = std::clamp(middle, frame.area.min.y - 3, frame.area.max.y + 3 - size.y);
    if (std::abs(top - middle) > 0.6f * size.y) continue;
    draw_text(frame.list, Face::small, {frame.area.min.x - size.x - 6 * frame.scale, top},
              frame.palette.muted, place.label);
  }
}

// Labels under the area, from the left; pushed inwards at the ends rather than cut off or left out.
void draw_place_below(const PlotFrame& frame, double at, const std::string& label, float right) {
  const float x = frame.x_of(at);
  upright_line(frame, x, colour(frame.palette.grid));
  const ImVec2 size = text_size(Face::small, label);
  const float left = std::clamp(x - 0.5f * size.x, frame.area.min.x - 0.3f * size.x,
                                std::max(frame.area.min.x - 0.3f * size.x, right - size.x));
  if (std::abs(left + 0.5f * size.x - x) > 0.4f * size.x) return;
  draw_text(frame.list, Face::small, {left, frame.area.max.y + 4 * frame.scale},
            frame.palette.muted, label);
}

void draw_time_axis(const PlotFrame& frame, double time_offset) {
  const double low = frame.window.start() - time_offset;
  const double high = frame.window.stop() - time_offset;
  const bool clock = std::max(std::abs(low), std::abs(high)) >= 60;
  const double step_guess = nice_step(high - low, 8);
  const ImVec2 widest = text_size(Face::small, time_text(-std::abs(high), step_guess, clock));
  const int most = std::max(1, static_cast<int>(frame.area.width() / (1.9f * widest.x)));
  const Ticks ticks = time_ticks(low, high, most);
  for (std::int64_t i = ticks.first; i <= ticks.last; ++i) {
    draw_place_below(frame, ticks.at(i) + time_offset, time_text(ticks.at(i), ticks.step, clock),
                     frame.outer.max.x);
  }
}

// What the axis shows, at its right end; its numbers leave room for that.
void draw_across_axis(const PlotFrame& frame, const PlotSpec& spec) {
  const std::string unit = unit_text(spec.x, frame.x);
  const std::string name = spec.x.label.empty() ? unit : spec.x.label + "  " + unit;
  const float room = 0.75f * frame.area.width();
  const float wide = std::min(room, text_size(Face::small, name).x);
  const float left = frame.area.max.x - wide;
  draw_clipped_text(frame.list, Face::small, {left, frame.area.max.y + 4 * frame.scale},
                    frame.palette.text, name, room);
  const float widest = text_size(Face::small, "\u22120.00").x;
  const auto most = static_cast<double>(frame.area.width() / (1.6f * widest));
  for (const AxisPlace& place : axis_places(spec.x, frame.x, most)) {
    draw_place_below(frame, place.value, place.label, left - 4 * frame.scale);
  }
}

}  // namespace

void draw_axes(const PlotFrame& frame, const PlotSpec& spec, double time_offset) {
  if (spec.kind == PlotKind::time) {
    draw_time_axis(frame, time_offset);
  } else {
    draw_across_axis(frame, spec);
  }
  draw_value_axis(frame, spec);
  const float zero = frame.y_of(0);
  if (spec.y.zero_line && !frame.y.log && zero >= frame.area.min.y && zero <= frame.area.max.y) {
    level_line(frame, zero, colour(frame.palette.axis));
  }
  const float left = frame.x_of(0);
  if (spec.kind == PlotKind::cross && spec.x.zero_line && left >= frame.area.min.x &&
      left <= frame.area.max.x) {
    upright_line(frame, left, colour(frame.palette.axis));
  }
}

}  // namespace limpid
