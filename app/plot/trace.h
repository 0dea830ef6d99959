// Shapes of curves and bands on pixels, as the window draws them and picture files store them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "app/base/welch.h"
#include "app/plot/axis.h"
#include "app/plot/history.h"
#include "app/plot/plot_spec.h"

namespace limpid {

// A stretch of pixels in which a band's channel says the same: the number of a name.
struct BandStretch {
  int said;
  std::size_t from, to;  // [px]
};

// Returns the stretches from left to right; `rows` are those of the pixels. Empty if the band says
// nothing of interest there.
std::vector<BandStretch> band_stretches(const Band& band, const History& history,
                                        const std::vector<SampleIndex>& rows);
// Returns the keys of the marks that bands say there.
std::vector<std::string> said_by_bands(std::span<const Band> bands, const History& history,
                                       const std::vector<SampleIndex>& rows);

// A stretch of the time axis over a row of pixels. It begins at a whole multiple of a pixel's
// duration: a moving window then gathers the same samples in a pixel from frame to frame, and noise
// does not shimmer.
struct PixelWindow {
  double per_pixel = 1;          // [s]
  std::int64_t first_pixel = 0;  // counted from time 0
  int pixels = 1;

  double time(double pixel) const { return (static_cast<double>(first_pixel) + pixel) * per_pixel; }
  double pixel(double time) const { return time / per_pixel - static_cast<double>(first_pixel); }
  double start() const { return time(0); }
  double stop() const { return time(pixels); }
};

// Makes a window whose end is within a pixel of `stop`. `length` > 0 [s], `pixels` > 0.
PixelWindow pixel_window(double stop, double length, int pixels);

// Finds the first row of the history for each pixel, and one more for the end of the last. All
// curves of a plot share them.
void pixel_rows(const History& history, const PixelWindow& window, std::vector<SampleIndex>& rows);

struct TracePoint {
  float x;    // [pixel] from the left end of the window
  float low;  // in the channel's unit; low == high where a point is one sample
  float high;
};

// A run of points that are joined to one another. `law` made them; -1: not asked for.
struct TraceRun {
  std::size_t first;
  std::size_t count;
  int law;
};

// Returns the law that made the curve's value of this row; -1 where the curve does not ask.
int law_at(const History& history, const Curve& curve, SampleIndex row);

struct Trace {
  bool band = false;     // a point holds the extent of all samples of a pixel
  bool wanders = false;  // x does not only grow
  std::vector<TracePoint> points;
  std::vector<TraceRun> runs;

  void clear();
};

// Builds the runs of one trace, point by point.
class TracePen {
 public:
  explicit TracePen(Trace& trace) : trace_(trace) { trace_.clear(); }

  bool down() const { return down_; }
  TracePoint& last() { return trace_.points.back(); }

  void lift() { down_ = false; }

  // Joins the point to the one before while the pen is down. Where another law begins, so does a
  // run, at the end of the one before.
  void put(const TracePoint& point, int law = -1) {
    const bool other = down_ && trace_.runs.back().law != law;
    if (!down_ || other) trace_.runs.push_back({trace_.points.size(), 0, law});
    if (other) {
      trace_.points.push_back(TracePoint(last()));
      ++trace_.runs.back().count;
    }
    down_ = true;
    trace_.points.push_back(point);
    ++trace_.runs.back().count;
  }

 private:
  Trace& trace_;
  bool down_ = false;
};

// Fills `trace` (its memory is used again) with the curve inside the window. Gaps of the history
// and values that are not numbers end a run.
void make_trace(const History& history, const Curve& curve, const PixelWindow& window,
                const std::vector<SampleIndex>& rows, Trace& trace);

// Area of a trace over another channel or of a spectrum.
struct TraceArea {
  AxisMap x, y;
  int width, height;  // [pixel]
};
// Fills `trace` with the rows [from, to) of a curve over another channel.
void make_cross_trace(const History& history, const Curve& curve, SampleIndex from, SampleIndex to,
                      const TraceArea& area, Trace& trace);

// Fills `trace` with the highest amplitude of the frequencies that share a pixel. Leaves out 0 Hz,
// which has no place on a logarithmic axis.
void make_spectrum_trace(const AmplitudeSpectrum& spectrum, const TraceArea& area, Trace& trace);

// Rows that a spectrum takes at most: the newest.
inline constexpr SampleIndex kMostOfSpectrum = 1 << 18;
// Returns the spectrum of the longest part of the stretch without gaps in rows or channel.
AmplitudeSpectrum spectrum_between(const History& history, int channel, double start, double stop);

}  // namespace limpid
