// Frame of a plot: its place on the screen, and the functions that draw its parts.
#pragma once

#include <imgui.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/plot/axis.h"
#include "app/plot/history.h"
#include "app/plot/label_room.h"
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
  LabelRoom::Box box() const {
    return {static_cast<double>(min.x), static_cast<double>(min.y), static_cast<double>(width()),
            static_cast<double>(height())};
  }
  bool contains(ImVec2 p) const {
    return p.x >= min.x && p.x < max.x && p.y >= min.y && p.y < max.y;
  }
};

struct PlotFrame {
  ImDrawList& list;
  const Palette& palette;
  float scale;
  ScreenRect outer;    // the whole plot
  ScreenRect area;     // of the curves
  PixelWindow window;  // the stretch of time
  AxisMap x;           // if over time: the window
  AxisMap y;           // in the channels' unit

  float x_of(double value) const {
    return area.min.x + static_cast<float>(std::clamp(x.part(value) * area.width(), -1e5, 1e5));
  }
  float y_of(double value) const {
    return area.max.y - static_cast<float>(std::clamp(y.part(value) * area.height(), -1e5, 1e5));
  }
  double x_at(float pixel) const { return x.value((pixel - area.min.x) / area.width()); }
  double y_at(float pixel) const { return y.value((area.max.y - pixel) / area.height()); }
  TraceArea trace_area() const {
    return {x, y, static_cast<int>(area.width()), static_cast<int>(area.height())};
  }
};

ImVec2 text_size(Face face, const std::string& text);
// Draws at whole pixels, where text is sharpest.
void draw_text(ImDrawList& list, Face face, ImVec2 at, Rgb rgb, const std::string& text);
// Ends the text with an ellipsis if it is wider than `width`; returns the width used.
float draw_clipped_text(ImDrawList& list, Face face, ImVec2 at, Rgb rgb, const std::string& text,
                        float width);

// Draws grid, labels and unit scaling of both axes; `time_offset` is subtracted from the labels
// [s].
void draw_axes(const PlotFrame& frame, const PlotSpec& spec, double time_offset);
// Tint the spec's bands behind the curves, and name them over the curves. `rows` are those of the
// frame's pixels.
void draw_bands(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                const std::vector<SampleIndex>& rows);
void draw_band_names(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                     const std::vector<SampleIndex>& rows, LabelRoom& room);
void draw_thresholds(const PlotFrame& frame, const PlotSpec& spec, LabelRoom& room);
// Draw a line behind the curves wherever something was changed, and over them what it was, where
// they leave room.
void draw_mark_lines(const PlotFrame& frame, const History& history);
void draw_mark_labels(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                      const std::vector<SampleIndex>& rows, std::span<const Trace> traces,
                      ImVec2 mouse, LabelRoom& room);

// Returns the time of the note under the mouse; nothing without one.
std::optional<double> note_near(const PlotFrame& frame, const History& history, ImVec2 mouse);

// Draws a curve, each part in the colour of what made it; `emphasis` below 1 fades it, above 1
// thickens it.
void draw_trace(const PlotFrame& frame, const Trace& trace, const Curve& curve, float emphasis);

// Draws signs that tell a second run's curve from the first one's; over time they move with the
// data.
void draw_run_signs(const PlotFrame& frame, const Trace& trace, const Curve& curve, float emphasis);
// Draws one sign around a point.
void draw_run_sign(ImDrawList& list, ImVec2 at, RunSign sign, ImU32 rgba, ImU32 back, float scale);

// Draws the curves' values at a time, in their colours, in the margin beside the area: at the
// mouse, where playback stands, or at the right end. end_label_width() is the width of that margin.
float end_label_width();
void draw_end_labels(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                     double time);

// Draws the values in a box beside `time`, with a dot on every visible curve. Over time there is a
// line at `time`, too.
void draw_read_out(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                   double time, ImVec2 near_to);
// Draws the same for spectra, one for each curve, at a frequency [Hz].
void draw_spectrum_read_out(const PlotFrame& frame, const PlotSpec& spec,
                            const std::vector<AmplitudeSpectrum>& spectra, double frequency,
                            ImVec2 near_to);
// Draws, over another channel, where the curves are at `time`.
void draw_present(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                  double time);
// Returns, over another channel, the time of the row closest to the mouse, if one is near.
std::optional<double> time_near(const PlotFrame& frame, const PlotSpec& spec,
                                const History& history, ImVec2 mouse);

// Draws a selection behind the curves, from one time to another.
void draw_range(const PlotFrame& frame, double start, double stop);

// Draws a line that can be dragged, with a handle on top.
void draw_playback(const PlotFrame& frame, double time, bool held);

// Draws three dots that open the menu; nothing if the button has no height.
void draw_menu_button(const PlotFrame& frame, const ScreenRect& button, bool pointed_at);

// Draws a short message at the bottom.
void draw_notice(const PlotFrame& frame, const std::string& text, bool bad, float alpha);

}  // namespace limpid
