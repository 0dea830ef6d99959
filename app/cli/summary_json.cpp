#include "app/cli/summary_json.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

namespace limpid {

using nlohmann::ordered_json;

namespace {

// Returns a key with its unit behind: "largest_error_rad", "rms_human_force_N".
std::string key_in(std::string name, std::string unit) {
  std::ranges::replace(unit, ' ', '_');
  return std::move(name) + "_" + unit;
}

}  // namespace

ordered_json summary_json(const Summary& summary) {
  const Summary::Totals& t = summary.totals();
  const NormUnits& in = summary.units();
  const std::string effort = std::string_view(in.torque) == "N" ? "force" : "torque";
  ordered_json json{
      {"ticks", t.rows},
      {"share_in_contact", t.share_in_contact()},
      {key_in("largest_error", in.angle), in.angles * t.largest_error},
      {key_in("largest_contact_" + effort, in.torque), in.torques * t.largest_contact},
      {key_in("rms_human_" + effort, in.torque), in.torques * t.human_rms()},
      {"energy_total_J", t.energy_total},
      {"highest_energy_total_J", t.highest_total},
      {"energy_commanded_J", t.energy_commanded}};
  if (t.warmest > 0) {
    json["largest_motor_warmth"] = t.warmest;
    json["held_by_warmth_s"] = t.held_by_warmth;
  }
  if (summary.watch().lost()) json["unstable_at_s"] = summary.watch().since();
  return json;
}

ordered_json runs_json(const std::vector<const Summary*>& lanes,
                       const std::vector<std::string>& warnings, std::span<const double> at_limit) {
  ordered_json runs = ordered_json::array();
  for (const Summary* lane : lanes) runs.push_back(summary_json(*lane));
  for (std::size_t i = 0; i < at_limit.size(); ++i) runs[i]["at_limit_s"] = at_limit[i];
  return {{"runs", runs}, {"warnings", warnings}};
}

}  // namespace limpid
