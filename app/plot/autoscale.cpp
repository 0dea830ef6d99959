#include "app/plot/autoscale.h"

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
  // A magnitude's axis begins at zero: below there is nothing.
  return {low == 0 ? 0 : std::floor((low - margin) / round_to) * round_to,
          std::ceil((high + margin) / round_to) * round_to};
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

}  // namespace limpid
