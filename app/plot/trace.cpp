#include "app/plot/trace.h"

#include <algorithm>
#include <cmath>

namespace limpid {

std::vector<BandStretch> band_stretches(const Band& band, const History& history,
                                        const std::vector<SampleIndex>& rows) {
  std::vector<BandStretch> stretches;
  if (history.empty() || rows.size() < 2) return stretches;
  const Extent all = history.extent(band.channel, rows.front(), rows.back());
  if (!(all.low < all.high) && !band.names.front().empty()) return stretches;
  const auto most = static_cast<int>(band.names.size()) - 1;
  const auto at = [&](std::size_t pixel) {
    if (rows[pixel] >= rows[pixel + 1]) return -1;
    const Extent said = history.extent(band.channel, rows[pixel], rows[pixel + 1]);
    return said.empty() ? -1 : std::clamp(static_cast<int>(std::lround(said.high)), 0, most);
  };
  for (std::size_t pixel = 0; pixel + 1 < rows.size(); ++pixel) {
    const int now = at(pixel);
    if (now < 0) continue;
    const std::size_t from = pixel;
    while (pixel + 2 < rows.size() && at(pixel + 1) == now) ++pixel;
    stretches.push_back({now, from, pixel + 1});
  }
  return stretches;
}

std::vector<std::string> said_by_bands(std::span<const Band> bands, const History& history,
                                       const std::vector<SampleIndex>& rows) {
  std::vector<std::string> keys;
  for (const Band& band : bands) {
    if (!band.key.empty() && !band_stretches(band, history, rows).empty()) keys.push_back(band.key);
  }
  return keys;
}

int law_at(const History& history, const Curve& curve, SampleIndex row) {
  if (curve.law_channel < 0) return -1;
  const float law = history.value(curve.law_channel, row);
  return std::isfinite(law) ? static_cast<int>(std::lround(law)) : -1;
}

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
    pen.put(point, law_at(history, curve, from));
  }
}

void trace_samples(const History& history, const Curve& curve, const PixelWindow& window,
                   const std::vector<SampleIndex>& rows, TracePen& pen) {
  // A row more on either side lets the line go on to the edge.
  const SampleIndex from = rows.front() > history.first() ? rows.front() - 1 : history.first();
  const SampleIndex to = std::min(rows.back() + 1, history.end());
  for (SampleIndex row = from; row < to; ++row) {
    const float value = history.value(curve.channel, row);
    if (!std::isfinite(value) || history.gap_before(row)) pen.lift();
    if (!std::isfinite(value)) continue;
    pen.put({static_cast<float>(window.pixel(history.time(row))), value, value},
            law_at(history, curve, row));
  }
}

constexpr double kApart = 0.5;  // points closer than that are one [pixel]

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

void make_cross_trace(const History& history, const Curve& curve, SampleIndex from, SampleIndex to,
                      const TraceArea& area, Trace& trace) {
  TracePen pen(trace);
  trace.wanders = true;
  double last_x = 0, last_y = 0;
  for (SampleIndex row = from; row < to; ++row) {
    const float across = history.value(curve.across, row);
    const float value = history.value(curve.channel, row);
    const bool there = std::isfinite(across) && std::isfinite(value);
    if (!there || history.gap_before(row)) pen.lift();
    if (!there) continue;
    const double x = area.x.part(static_cast<double>(across)) * area.width;
    const double y = area.y.part(static_cast<double>(value)) * area.height;
    if (pen.down() && std::max(std::abs(x - last_x), std::abs(y - last_y)) < kApart) continue;
    last_x = x;
    last_y = y;
    pen.put({static_cast<float>(std::clamp(x, -1e5, 1e5)), value, value},
            law_at(history, curve, row));
  }
}

void make_spectrum_trace(const AmplitudeSpectrum& spectrum, const TraceArea& area, Trace& trace) {
  TracePen pen(trace);
  double shown = -1e9;  // pixel of the last point
  for (std::size_t i = 1; i < spectrum.amplitude.size(); ++i) {
    const double x = area.x.part(static_cast<double>(i) * spectrum.step) * area.width;
    const auto value = static_cast<float>(spectrum.amplitude[i]);
    const TracePoint point{static_cast<float>(std::clamp(x, -1e5, 1e5)), value, value};
    if (std::floor(x) > shown) {
      pen.put(point);
      shown = std::floor(x);
    } else if (value > pen.last().high) {
      pen.last() = point;
    }
  }
}

AmplitudeSpectrum spectrum_between(const History& history, int channel, double start, double stop) {
  const SampleIndex to = history.lower_bound(stop);
  const SampleIndex first = history.lower_bound(start);
  const SampleIndex from = to - std::min(to - std::min(first, to), kMostOfSpectrum);
  std::vector<double> part, longest;
  const auto end_part = [&] {
    if (part.size() > longest.size()) longest.swap(part);
    part.clear();
  };
  for (SampleIndex row = from; row < to; ++row) {
    const auto value = static_cast<double>(history.value(channel, row));
    if (history.gap_before(row) || !std::isfinite(value)) end_part();
    if (std::isfinite(value)) part.push_back(value);
  }
  end_part();
  return amplitude_spectrum(longest, 1 / history.tick());
}

}  // namespace limpid
