#include "app/cli/summary_json.h"

namespace limpid {

using nlohmann::ordered_json;

ordered_json summary_json(const Summary& summary) {
  const Summary::Totals& t = summary.totals();
  ordered_json json{{"ticks", t.rows},
                    {"share_in_contact", t.share_in_contact()},
                    {"largest_error_rad", t.largest_error},
                    {"largest_contact_torque_N_m", t.largest_contact},
                    {"rms_human_torque_N_m", t.human_rms()},
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
                       const std::vector<std::string>& warnings) {
  ordered_json runs = ordered_json::array();
  for (const Summary* lane : lanes) runs.push_back(summary_json(*lane));
  return {{"runs", runs}, {"warnings", warnings}};
}

}  // namespace limpid
