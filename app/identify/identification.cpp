#include "app/identify/identification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/run/analysis.h"
#include "devices/identify/torque_scale.h"

namespace limpid {

Identification identification(std::string device, const IdentifyRequest& order, IdentifyRun bare,
                              IdentifyRun with_load) {
  Identification out{.device = std::move(device),
                     .order = order,
                     .bare = std::move(bare),
                     .with_load = std::move(with_load),
                     .torque_scale = {},
                     .found = {},
                     .inertia_in_file = {}};
  out.found = identify(order.guess, out.bare.record, order.fit);
  if (order.load > 0) {
    out.torque_scale = torque_scale_by_load(out.found, out.bare.record, out.with_load.record,
                                            order.load, order.fit);
  } else if (order.masses_right) {
    out.torque_scale = torque_scale_by_masses(order.guess, out.found, out.bare.record, order.fit);
  }
  if (out.torque_scale) {
    MotionRecord given = out.bare.record;
    given.torque *= out.torque_scale->value;
    out.found = identify(order.guess, given, order.fit);
  }
  const Eigen::VectorXd inertia = arm_at(order.guess, out.found.middle).M.diagonal();
  out.inertia_in_file.assign(inertia.begin(), inertia.end());
  return out;
}

std::string device_text(const Identification& identification) {
  std::string text =
      fmt::format("Delay from a reading to the torque that answers it: {} ms, beyond the tick.",
                  text_of(identification.found.delay, 1e-3));
  const ReadingTimes& timing = identification.bare.timing;
  if (timing.rate > 0) {
    text += fmt::format(
        " {:.0f} readings a second, {:.2f} ms apart in the middle, {:.2f} ms at 99 %, {:.2f} ms at "
        "most.",
        timing.rate, 1e3 * timing.p50, 1e3 * timing.p99, 1e3 * timing.most);
  }
  if (identification.torque_scale) {
    text += fmt::format(" The motors give {} times what they are told, from {}.",
                        text_of(*identification.torque_scale, 1),
                        identification.order.load > 0
                            ? fmt::format("a load of {:g} kg at the tip", identification.order.load)
                            : std::string("the masses of the arm's file"));
  }
  return with_plus_minus(text);
}

// With the digits that the deviation leaves, four that count at most.
std::string text_of(const Found& found, double per_unit) {
  const auto size = [](double x) {
    return x > 0 ? static_cast<int>(std::floor(std::log10(x))) : 0;
  };
  const double value = found.value / per_unit, deviation = found.deviation / per_unit;
  const int most = std::clamp(3 - size(std::abs(value)), 0, 4);
  const int digits = deviation > 0 ? std::clamp(1 - size(deviation), 0, most) : most;
  const double unit = std::pow(10, digits);
  return fmt::format("{:.{}f} +- {:.{}f}", std::round(value * unit) / unit + 0.0,  // no -0
                     digits, deviation, digits);
}

std::string with_plus_minus(std::string text) {
  for (auto at = text.find("+-"); at != std::string::npos; at = text.find("+-")) {
    text.replace(at, 2, "\xC2\xB1");
  }
  return text;
}

std::string explain(const IdentifyRun& run, const IdentifyRequest& order) {
  std::string text = explain(run.end);
  if (run.end == ExcitationEnd::held) {
    text += fmt::format(" ({})", order.guess.joints[static_cast<std::size_t>(run.joint)].name);
  }
  if (run.objection != ForceState::on) text += fmt::format(" ({})", explain(run.objection));
  return text;
}

}  // namespace limpid
