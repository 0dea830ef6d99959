#include "app/identify/identification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "devices/identify/torque_scale.h"

namespace limpid {

Identification identification(std::string device, const IdentifyOrder& order, IdentifyRun bare,
                              IdentifyRun with_load) {
  Identification out{.device = std::move(device),
                     .order = order,
                     .bare = std::move(bare),
                     .with_load = std::move(with_load),
                     .torque_scale = {},
                     .found = {}};
  out.found = identify(order.guess, out.bare.record, order.fit);
  if (order.load > 0) {
    out.torque_scale = torque_scale_by_load(out.found, out.bare.record, out.with_load.record,
                                            order.load, order.fit);
  } else if (order.masses_right) {
    out.torque_scale = torque_scale_by_masses(order.guess, out.found, out.bare.record, order.fit);
  }
  if (!out.torque_scale) return out;
  MotionRecord given = out.bare.record;
  given.torque *= out.torque_scale->value;
  out.found = identify(order.guess, given, order.fit);
  return out;
}

// With the digits that the deviation leaves, four at most.
std::string text_of(const Found& found, double per_unit) {
  const double deviation = found.deviation / per_unit;
  const int digits =
      deviation > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(deviation))), 0, 4) : 3;
  const double unit = std::pow(10, digits);
  const double value = std::round(found.value / per_unit * unit) / unit + 0.0;  // no -0
  return fmt::format("{:.{}f} +- {:.{}f}", value, digits, deviation, digits);
}

std::string explain(const IdentifyRun& run, const IdentifyOrder& order) {
  std::string text = explain(run.end);
  if (run.end == ExcitationEnd::held) {
    text += fmt::format(" ({})", order.guess.joints[static_cast<std::size_t>(run.joint)].name);
  }
  if (run.objection != ForceState::on) text += fmt::format(" ({})", explain(run.objection));
  return text;
}

}  // namespace limpid
