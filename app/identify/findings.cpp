#include "app/identify/findings.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

namespace limpid {
namespace {

using nlohmann::ordered_json;

ordered_json as_json(const Found& found) {
  return {{"value", found.value}, {"deviation", found.deviation}};
}

Found read_found(const nlohmann::json& json) {
  return {json.at("value").get<double>(), json.at("deviation").get<double>()};
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

}  // namespace

std::string findings_text(const Identification& identification, const std::string& more) {
  const Identified& found = identification.found;
  const IdentifyRun& run = identification.bare;
  ordered_json json{
      {"device", identification.device},
      {"arm", found.arm.name},
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

}  // namespace limpid
