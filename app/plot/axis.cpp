#include "app/plot/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/style/ticks.h"

namespace limpid {

namespace {

constexpr double kMargin = 0.08;    // of the data's span, on both sides
constexpr double kWasteful = 0.62;  // shrink when the data needs less of the axis than this ...
constexpr double kPatience = 3.0;   // ... for so long [s]
constexpr double kGlide = 0.09;     // time constant [s]

Limits around(const Limits& data, double smallest_span) {
  double low = data.low;
  double high = data.high;
  if (high - low < smallest_span) {
    const double missing = smallest_span - (high - low);
    low -= low == 0 ? 0 : missing / 2;
    high = low + smallest_span;
  }
  const double margin = kMargin * (high - low);
  const double round_to = nice_step(high - low, 10);
  // A magnitude's axis begins at zero, as no value is below.
  return {low == 0 ? 0 : std::floor((low - margin) / round_to) * round_to,
          std::ceil((high + margin) / round_to) * round_to};
}

std::string log_text(double value) {
  const int exponent = static_cast<int>(std::round(std::log10(value)));
  if (exponent >= -3 && exponent <= 4) return fmt::format("{:.6g}", value);
  const std::string power = exponent_text(exponent);  // "\u00d710\u207b\u2076"
  const std::string mantissa = fmt::format("{:.0f}", value / std::pow(10, exponent));
  return mantissa == "1" ? power.substr(std::string("\u00d7").size()) : mantissa + power;
}

// Returns decades and places between them; 2 and 5 have labels where there are few decades.
std::vector<AxisPlace> log_places(const AxisMap& map, double factor, double most) {
  std::vector<AxisPlace> places;
  const double shift = std::log10(factor);
  const double low = map.limits.low + shift, high = map.limits.high + shift;
  const int apart = std::max(1, static_cast<int>(std::ceil((high - low) / std::max(1.0, most))));
  const bool few = high - low < 1.5;
  for (int decade = static_cast<int>(std::floor(low)); decade <= high; ++decade) {
    for (int m = 1; m < 10; ++m) {
      const double value = m * std::pow(10, decade);
      if (std::log10(value) < low - 1e-9 || std::log10(value) > high + 1e-9) continue;
      const bool named = (m == 1 && decade % apart == 0) || (few && (m == 2 || m == 5));
      if (!named && high - low > 4) continue;
      places.push_back({value / factor, named ? log_text(value) : ""});
    }
  }
  return places;
}

}  // namespace

Limits Autoscale::update(const Limits& data, double smallest_span, double elapsed) {
  const Limits wanted = around(data, smallest_span);
  if (!shown_) {
    shown_ = target_ = wanted;
    return wanted;
  }
  if (data.low < target_.low || data.high > target_.high) {
    target_ = {std::min(wanted.low, target_.low), std::max(wanted.high, target_.high)};
    unused_for_ = 0;
  } else if (wanted.span() < kWasteful * target_.span()) {
    unused_for_ += elapsed;
    if (unused_for_ > kPatience) target_ = wanted;
  } else {
    unused_for_ = 0;
  }
  const double part = 1 - std::exp(-elapsed / kGlide);
  shown_->low += part * (target_.low - shown_->low);
  shown_->high += part * (target_.high - shown_->high);
  const double close = 1e-3 * target_.span();
  if (std::abs(shown_->low - target_.low) + std::abs(shown_->high - target_.high) < close) {
    shown_ = target_;
  }
  shown_->low = std::min(shown_->low, data.low);
  shown_->high = std::max(shown_->high, data.high);
  return *shown_;
}

std::vector<AxisPlace> axis_places(const PlotAxis& axis, const AxisMap& map, double most) {
  if (map.log) return log_places(map, axis.factor, most);
  std::vector<AxisPlace> places;
  const double low = map.limits.low * axis.factor, high = map.limits.high * axis.factor;
  const Ticks ticks = nice_ticks(low, high, std::max(2, static_cast<int>(most)));
  const int exponent = common_exponent(low, high);
  for (std::int64_t i = ticks.first; i <= ticks.last; ++i) {
    places.push_back({ticks.at(i) / axis.factor, tick_text(ticks.at(i), ticks.step, exponent)});
  }
  return places;
}

std::string unit_text(const PlotAxis& axis, const AxisMap& map) {
  if (map.log) return axis.unit;
  const std::string scaling =
      exponent_text(common_exponent(map.limits.low * axis.factor, map.limits.high * axis.factor));
  return scaling.empty() ? axis.unit : scaling + " " + axis.unit;
}

}  // namespace limpid
