// Where a plot lies on the screen during one frame, and the parts that draw into it.
#pragma once

#include <imgui.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "app/plot/autoscale.h"
#include "app/plot/history.h"
#include "app/plot/plot_spec.h"
#include "app/plot/trace.h"
#include "app/style/theme.h"

namespace limpid {

struct ScreenRect {
  ImVec2 min;
  ImVec2 max;

  float width() const { return max.x - min.x; }
  float height() const { return max.y - min.y; }
  ImVec2 size() const { return {width(), height()}; }
  bool contains(ImVec2 p) const {
    return p.x >= min.x && p.x < max.x && p.y >= min.y && p.y < max.y;
  }
};

struct PlotFrame {
  ImDrawList& list;
  const Palette& palette;
  float scale;
  ScreenRect outer;  // the whole plot
  ScreenRect area;   // where the curves are
  PixelWindow window;
  Limits y;  // in the channels' unit

  float x_of(double time) const { return area.min.x + static_cast<float>(window.pixel(time)); }
  float y_of(double value) const {
    const double up = (value - y.low) / y.span() * area.height();
    return static_cast<float>(std::clamp(area.max.y - up, -1e5, 1e5));
  }
  double time_at(float x) const { return window.time(x - area.min.x); }
  double value_at(float y_pixel) const {
    return y.low + (area.max.y - y_pixel) / area.height() * y.span();
  }
};

ImVec2 text_size(Face face, const std::string& text);
// At whole pixels, where text is sharpest.
void draw_text(ImDrawList& list, Face face, ImVec2 at, Rgb rgb, const std::string& text);
// Ends with an ellipsis where it would be wider than `width`; returns the width used.
float draw_clipped_text(ImDrawList& list, Face face, ImVec2 at, Rgb rgb, const std::string& text,
                        float width);

// Grid, labels and unit scaling of both axes; `time_offset` is subtracted from the labels [s].
void draw_axes(const PlotFrame& frame, const PlotSpec& spec, double time_offset);
// Tints the spec's band: once `rows` are those of the frame's pixels.
void draw_bands(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                const std::vector<SampleIndex>& rows);
void draw_thresholds(const PlotFrame& frame, const PlotSpec& spec);
void draw_marks(const PlotFrame& frame, const History& history, ImVec2 mouse);

// `emphasis` below 1 fades the curve, above 1 thickens it.
void draw_trace(const PlotFrame& frame, const Trace& trace, Rgb rgb, float emphasis);

// The line at `time` with a dot on every visible curve, and the values in a box beside it.
void draw_read_out(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                   double time, ImVec2 near_to);

// A line that can be dragged, with a handle on top.
void draw_playback(const PlotFrame& frame, double time, bool held);

// A short message at the bottom.
void draw_notice(const PlotFrame& frame, const std::string& text, bool bad, float alpha);

}  // namespace limpid
