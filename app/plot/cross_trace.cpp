// Traces over anything but time.
#include <algorithm>
#include <cmath>

#include "app/plot/trace.h"

namespace limpid {
namespace {

constexpr double kApart = 0.5;  // points closer than that are one [pixel]

}  // namespace

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
    pen.put({static_cast<float>(std::clamp(x, -1e5, 1e5)), value, value});
  }
}

void make_spectrum_trace(const AmplitudeSpectrum& spectrum, const TraceArea& area, Trace& trace) {
  TracePen pen(trace);
  double shown = -1e9;  // the pixel that the last point stands for
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
