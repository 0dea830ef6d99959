// What of a curve falls on which pixel: the shape that the window draws and picture files store.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/plot/history.h"
#include "app/plot/plot_spec.h"

namespace limpid {

// A stretch of the time axis over a row of pixels. It begins at a whole multiple of a pixel's
// duration, so that a moving window gathers the same samples in a pixel from frame to frame and
// noise does not shimmer.
struct PixelWindow {
  double per_pixel = 1;          // [s]
  std::int64_t first_pixel = 0;  // counted from time 0
  int pixels = 1;

  double time(double pixel) const { return (static_cast<double>(first_pixel) + pixel) * per_pixel; }
  double pixel(double time) const { return time / per_pixel - static_cast<double>(first_pixel); }
  double start() const { return time(0); }
  double stop() const { return time(pixels); }
};

// `length` > 0 [s], `pixels` > 0. The window's end is within a pixel of `stop`.
PixelWindow pixel_window(double stop, double length, int pixels);

// First row of the history for each pixel, and one more for the end of the last. Shared by all
// curves of a plot.
void pixel_rows(const History& history, const PixelWindow& window, std::vector<SampleIndex>& rows);

struct TracePoint {
  float x;    // [pixel] from the left end of the window
  float low;  // in the channel's unit; low == high where a point is one sample
  float high;
};

// Points to be joined to one another.
struct TraceRun {
  std::size_t first;
  std::size_t count;
  bool faint;  // the space between two dashes
};

struct Trace {
  bool band = false;  // a point holds the extent of all samples of a pixel
  std::vector<TracePoint> points;
  std::vector<TraceRun> runs;

  void clear();
};

// Fills `trace` (its memory is used again) with the curve inside the window. Gaps of the history
// and values that are not numbers end a run. `dash` is the length of a dash [pixel].
void make_trace(const History& history, const Curve& curve, const PixelWindow& window,
                const std::vector<SampleIndex>& rows, double dash, Trace& trace);

}  // namespace limpid
