#include "app/experiments/identification.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

#include "app/run/analysis.h"
#include "app/run/provenance.h"
#include "devices/identify/torque_scale.h"
#include "devices/identify/unlike_device.h"

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
  std::string text = fmt::format(
      "Delay from a reading to the torque computed from it: {} ms. The tick is not included.",
      text_of(identification.found.delay, 1e-3));
  const ReadingTimes& timing = identification.bare.timing;
  if (timing.rate > 0) {
    text += fmt::format(
        " {:.0f} readings per second. Time between two readings: median {:.2f} ms, 99th percentile "
        "{:.2f} ms, longest {:.2f} ms.",
        timing.rate, 1e3 * timing.p50, 1e3 * timing.p99, 1e3 * timing.most);
  }
  if (identification.torque_scale) {
    text += fmt::format(" The motors give {} times the commanded torque, computed from {}.",
                        text_of(*identification.torque_scale, 1),
                        identification.order.load > 0
                            ? fmt::format("a load of {:g} kg at the tip", identification.order.load)
                            : std::string("the masses of the arm's file"));
  }
  return with_plus_minus(text);
}

// Rounds to the digits that the deviation leaves, at most four significant ones. A deviation below
// the last of them counts as one there: none is shown smaller than it is.
std::string text_of(const Found& found, double per_unit) {
  const auto size = [](double x) {
    return x > 0 ? static_cast<int>(std::floor(std::log10(x))) : 0;
  };
  const double value = found.value / per_unit, deviation = found.deviation / per_unit;
  const int most = std::clamp(3 - size(std::abs(value)), 0, 4);
  const int digits = deviation > 0 ? std::clamp(1 - size(deviation), 0, most) : most;
  const double unit = std::pow(10, digits);
  const double shown = deviation > 0 ? std::max(deviation, 1 / unit) : deviation;
  return fmt::format("{:.{}f} +- {:.{}f}", std::round(value * unit) / unit + 0.0,  // no -0
                     digits, shown, digits);
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

namespace {

using nlohmann::ordered_json;

ordered_json as_json(const Found& found) {
  return {{"value", found.value}, {"deviation", found.deviation}};
}

Found read_found(const nlohmann::json& from) {
  return {from.at("value").get<double>(), from.at("deviation").get<double>()};
}

ordered_json joints_of(const Identified& found) {
  ordered_json joints = ordered_json::array();
  for (std::size_t j = 0; j < found.joints.size(); ++j) {
    const JointFinding& joint = found.joints[j];
    ordered_json each{{"name", found.arm.joints[j].name},
                      {"middle", found.middle[static_cast<Eigen::Index>(j)]}};
    for (const FindingInfo& info : kFindings) each[info.key] = as_json(joint.*info.field);
    each["residual"] = joint.residual;
    each["torque"] = joint.torque;
    each["samples"] = joint.samples;
    joints.push_back(std::move(each));
  }
  return joints;
}

Found in_units(const Found& found, double per_unit) {
  return {found.value / per_unit, found.deviation / per_unit};
}

Drift drift_of(std::string what, const char* unit, const Found& before, const Found& now) {
  constexpr double kDeviations = 3, kShare = 0.03;
  const double change = std::abs(now.value - before.value);
  const bool certain = change > kDeviations * std::hypot(before.deviation, now.deviation) +
                                    kShare * std::abs(before.value);
  return {std::move(what), unit, before, now, certain};
}

constexpr double kMostFriction = 0.03;  // [N m]

}  // namespace

std::string findings_text(const Identification& identification, const std::string& more) {
  const Identified& found = identification.found;
  const IdentifyRun& run = identification.bare;
  ordered_json json{
      {"device", identification.device},
      {"arm", found.arm.name},
      {"provenance", provenance("", identification.order.seed)},
      {"when", fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::localtime(std::time(nullptr)))},
      {"seconds", run.record.T * static_cast<double>(run.record.rows())},
      {"delay", as_json(found.delay)},
      {"joints", joints_of(found)}};
  if (identification.torque_scale) json["torque_scale"] = as_json(*identification.torque_scale);
  if (identification.order.load > 0) json["load"] = identification.order.load;
  if (run.timing.rate > 0) {
    json["readings"] = {{"rate", run.timing.rate},
                        {"interval_p50", run.timing.p50},
                        {"interval_p99", run.timing.p99},
                        {"interval_max", run.timing.most}};
  }
  if (!more.empty()) json.update(ordered_json::parse(more));
  return json.dump(2) + "\n";
}

std::optional<Findings> read_findings(const std::string& text) {
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    Findings out{
        .when = json.value("when", ""), .joints = {}, .delay = read_found(json.at("delay"))};
    for (const nlohmann::json& each : json.at("joints")) {
      JointFinding joint;
      for (const FindingInfo& info : kFindings) joint.*info.field = read_found(each.at(info.key));
      out.joints.push_back(joint);
    }
    return out;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

std::vector<Drift> drift(const Findings& before, const Identification& now) {
  const Identified& found = now.found;
  if (before.joints.size() != found.joints.size()) return {};
  std::vector<Drift> all;
  for (std::size_t j = 0; j < found.joints.size(); ++j) {
    for (const FindingInfo& info : kFindings) {
      all.push_back(drift_of(fmt::format("{} {}", found.arm.joints[j].name, info.label), info.unit,
                             in_units(before.joints[j].*info.field, info.per_unit),
                             in_units(found.joints[j].*info.field, info.per_unit)));
    }
  }
  all.push_back(drift_of("delay", "ms", in_units(before.delay, 1e-3), in_units(found.delay, 1e-3)));
  return all;
}

SimulatedBench simulated_bench(const IdentifyRequest& order, unsigned seed) {
  SimulatedBench bench{order.guess.name + ", simulated", unlike(order.guess, seed, kMostFriction),
                       drawn_bench(order.guess, seed, order.fit.gravity)};
  if (order.load > 0) bench.unlikeness.torque_scale = drawn_torque_scale(seed);
  return bench;
}

IdentifyRun move_simulated(const SimulatedBench& bench, const IdentifyRequest& order,
                           bool with_load, IdentifyProgress& progress) {
  UnlikeDevice device(with_load ? loaded(bench.truth, order.load) : bench.truth, bench.unlikeness);
  return simulate_identification(device, order.guess, order.plan, progress);
}

}  // namespace limpid
