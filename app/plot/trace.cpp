#include "app/plot/trace.h"

#include <algorithm>
#include <cmath>

namespace limpid {
namespace {

// Extends two neighbouring bands to the middle of the step between them: no holes where steep.
void close_step(TracePoint& before, TracePoint& after, float from, float to) {
  const float middle = 0.5f * (from + to);
  before.low = std::min(before.low, middle);
  before.high = std::max(before.high, middle);
  after.low = std::min(after.low, middle);
  after.high = std::max(after.high, middle);
}

void trace_bands(const History& history, const Curve& curve, const std::vector<SampleIndex>& rows,
                 TracePen& pen) {
  for (std::size_t pixel = 0; pixel + 1 < rows.size(); ++pixel) {
    const SampleIndex from = rows[pixel];
    const SampleIndex to = rows[pixel + 1];
    if (from == to) continue;
    const Extent extent = history.extent(curve.channel, from, to);
    if (extent.empty() || (pen.down() && history.gap_before(from))) pen.lift();
    if (extent.empty()) continue;
    const float x = static_cast<float>(pixel) + 0.5f;
    TracePoint point{x, extent.low, extent.high};
    if (pen.down()) {
      const float before = history.value(curve.channel, from - 1);
      const float after = history.value(curve.channel, from);
      if (std::isfinite(before) && std::isfinite(after)) {
        close_step(pen.last(), point, before, after);
      }
    }
    pen.put(point);
  }
}

void trace_samples(const History& history, const Curve& curve, const PixelWindow& window,
                   const std::vector<SampleIndex>& rows, TracePen& pen) {
  // One row more on either side: the line goes on to the edge.
  const SampleIndex from = rows.front() > history.first() ? rows.front() - 1 : history.first();
  const SampleIndex to = std::min(rows.back() + 1, history.end());
  for (SampleIndex row = from; row < to; ++row) {
    const float value = history.value(curve.channel, row);
    if (!std::isfinite(value) || history.gap_before(row)) pen.lift();
    if (!std::isfinite(value)) continue;
    pen.put({static_cast<float>(window.pixel(history.time(row))), value, value});
  }
}

}  // namespace

PixelWindow pixel_window(double stop, double length, int pixels) {
  const double per_pixel = length / pixels;
  return {per_pixel, static_cast<std::int64_t>(std::ceil(stop / per_pixel)) - pixels, pixels};
}

void pixel_rows(const History& history, const PixelWindow& window, std::vector<SampleIndex>& rows) {
  rows.resize(static_cast<std::size_t>(window.pixels) + 1);
  SampleIndex row = history.lower_bound(window.start());
  for (std::size_t pixel = 0; pixel < rows.size(); ++pixel) {
    row = history.lower_bound(window.time(static_cast<double>(pixel)), row);
    rows[pixel] = row;
  }
}

void Trace::clear() {
  band = wanders = false;
  points.clear();
  runs.clear();
}

void make_trace(const History& history, const Curve& curve, const PixelWindow& window,
                const std::vector<SampleIndex>& rows, Trace& trace) {
  TracePen pen(trace);
  if (history.empty() || rows.empty()) return;
  trace.band = window.per_pixel > history.tick();
  if (trace.band) {
    trace_bands(history, curve, rows, pen);
  } else {
    trace_samples(history, curve, window, rows, pen);
  }
}

}  // namespace limpid
