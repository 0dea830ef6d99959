#include "app/plot/trace.h"

#include <algorithm>
#include <cmath>

namespace limpid {
namespace {

constexpr double kDashPeriod = 1.7;  // dash and space, in lengths of a dash

// Builds the runs of one trace, point by point.
class Pen {
 public:
  explicit Pen(Trace& trace) : trace_(trace) { trace_.clear(); }

  bool down() const { return down_; }
  bool faint() const { return trace_.runs.back().faint; }
  TracePoint& last() { return trace_.points.back(); }

  void lift() { down_ = false; }

  // Joins the point to the one before while the pen is down. A change of faintness begins a new
  // run at the last point, without a hole.
  void put(const TracePoint& point, bool faint) {
    if (!down_ || trace_.runs.back().faint != faint) {
      trace_.runs.push_back({trace_.points.size(), 0, faint});
      if (down_) add(TracePoint(trace_.points.back()));
    }
    down_ = true;
    add(point);
  }

 private:
  void add(const TracePoint& point) {
    trace_.points.push_back(point);
    ++trace_.runs.back().count;
  }

  Trace& trace_;
  bool down_ = false;
};

class Dashes {
 public:
  Dashes(const History& history, const Curve& curve, const PixelWindow& window, double dash)
      : history_(history),
        curve_(curve),
        dash_(dash),
        period_(kDashPeriod * dash),
        phase_(std::fmod(static_cast<double>(window.first_pixel), period_)) {}

  bool dashed(SampleIndex row) const {
    if (curve_.dash_channel < 0) return curve_.dashed;
    return history_.value(curve_.dash_channel, row) < 0.5f;
  }
  bool in_space(double x) const { return place(x) >= dash_; }

  // Where the next dash or space begins, beyond x.
  double next_edge(double x) const {
    const double at = place(x);
    return x + (at < dash_ ? dash_ : period_) - at;
  }

 private:
  double place(double x) const {
    const double at = std::fmod(x + phase_, period_);
    return at < 0 ? at + period_ : at;
  }

  const History& history_;
  const Curve& curve_;
  double dash_;
  double period_;
  double phase_;
};

// Extends two neighbouring bands to the middle of the step between them: no holes where steep.
void close_step(TracePoint& before, TracePoint& after, float from, float to) {
  const float middle = 0.5f * (from + to);
  before.low = std::min(before.low, middle);
  before.high = std::max(before.high, middle);
  after.low = std::min(after.low, middle);
  after.high = std::max(after.high, middle);
}

void trace_bands(const History& history, const Curve& curve, const std::vector<SampleIndex>& rows,
                 const Dashes& dashes, Pen& pen) {
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
    pen.put(point, dashes.dashed(from) && dashes.in_space(x));
  }
}

void trace_samples(const History& history, const Curve& curve, const PixelWindow& window,
                   const std::vector<SampleIndex>& rows, const Dashes& dashes, Pen& pen) {
  // One row more on either side: the line goes on to the edge.
  const SampleIndex from = rows.front() > history.first() ? rows.front() - 1 : history.first();
  const SampleIndex to = std::min(rows.back() + 1, history.end());
  for (SampleIndex row = from; row < to; ++row) {
    const float value = history.value(curve.channel, row);
    if (!std::isfinite(value) || history.gap_before(row)) pen.lift();
    if (!std::isfinite(value)) continue;
    const double x = window.pixel(history.time(row));
    const TracePoint point{static_cast<float>(x), value, value};
    const bool dashed = dashes.dashed(row);
    if (pen.down() && dashed) {
      const TracePoint before = pen.last();
      const double begin = std::max<double>(before.x, -1);
      const double end = std::min<double>(x, window.pixels + 1);
      for (double edge = dashes.next_edge(begin); edge < end;
           edge = dashes.next_edge(edge + 1e-6)) {
        const auto part = static_cast<float>((edge - before.x) / (x - before.x));
        const float y = before.low + part * (value - before.low);
        pen.put({static_cast<float>(edge), y, y}, dashes.in_space(edge - 1e-3));
      }
    }
    pen.put(point, dashed && dashes.in_space(x - 1e-3));
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
  band = false;
  points.clear();
  runs.clear();
}

void make_trace(const History& history, const Curve& curve, const PixelWindow& window,
                const std::vector<SampleIndex>& rows, double dash, Trace& trace) {
  Pen pen(trace);
  if (history.empty() || rows.empty()) return;
  const Dashes dashes(history, curve, window, dash);
  trace.band = window.per_pixel > history.tick();
  if (trace.band) {
    trace_bands(history, curve, rows, dashes, pen);
  } else {
    trace_samples(history, curve, window, rows, dashes, pen);
  }
}

}  // namespace limpid
