#include "app/run/rerun.h"

#include <algorithm>
#include <array>
#include <utility>

#include "app/run/lane_settings.h"
#include "app/run/run_watch.h"
#include "app/run/summary.h"
#include "devices/files/config_file.h"

namespace limpid {

namespace {

RunFigures figures_of(std::string name, const Summary& summary) {
  const Summary::Totals& all = summary.totals();
  const NormUnits& units = summary.units();
  return {std::move(name),
          1e3 * units.angles * all.largest_error,
          units.torques * all.largest_contact,
          all.highest_total,
          units.milliangle,
          units.torque};
}

}  // namespace

RerunRows run_once_more(const Session& session, const std::string& where, const Parameters& chosen,
                        const std::atomic<bool>& stop, const std::function<void(double)>& at) {
  RunPlan plan = replay(session, where, chosen);
  plan.beside.clear();
  RerunRows again;
  again.arm = plan.arm;
  again.settings.push_back({0, plan.parameters});
  again.rows.reserve(session.rows.size());
  std::uint64_t count = 0;
  RunWatch watch(plan.arm, session.layout, plan.parameters);
  ForgetBehind forget;
  Summary of_run(session.layout, plan.arm), of_recording(session.layout, plan.arm);
  again.end = simulate(plan, {.realtime = false, .stop = &stop},
                       [&](std::span<const double> row, LaneChanges changed) {
                         if (const Parameters* now = changed[kMainLane]) {
                           watch.change(count, *now);
                           again.settings.push_back({count, *now});
                         }
                         watch.add(row);
                         of_run.add(row);
                         if (count < session.size()) of_recording.add(session.row(count));
                         again.rows.insert(again.rows.end(), row.begin(), row.end());
                         forget.passed(row.size_bytes());
                         at(static_cast<double>(++count) / static_cast<double>(plan.rows));
                         return true;
                       });
  again.at_limit = watch.at_limit();
  again.cautions = watch.cautions();
  if (again.end.stopped || again.rows.empty()) {
    again.rows.clear();
    return again;
  }
  const std::vector<double> last(again.rows.end() - session.layout.stride(), again.rows.end());
  while (again.rows.size() < session.rows.size()) {
    again.rows.insert(again.rows.end(), last.begin(), last.end());
  }
  const std::array both{session_parameters(session, where), chosen};
  const std::vector<std::string> names = lane_names(both);
  again.name = "re-run: " + (both[0] == both[1] ? "as recorded" : names[1]);
  // A setting that changed on the way is not the name of the whole recording.
  again.recorded = session.changes.empty() ? "recorded: " + names[0] : "recorded";
  again.figures = figures_of(again.name, of_run);
  again.recorded_figures = figures_of(again.recorded, of_recording);
  again.note = plan.note;
  return again;
}

std::vector<std::string> changed_settings(const Session& session, const std::string& where,
                                          const Parameters& chosen) {
  const Parameters before = session_parameters(session, where);
  std::vector<std::string> changes;
  for (const ParameterInfo* info : differing(chosen, before)) {
    changes.push_back(std::string(info->key) + "=" + parameter_text(chosen, *info));
  }
  return changes;
}

Parameters with_changes(const Session& session, const std::string& where,
                        const std::vector<std::string>& changes) {
  Parameters p = session_parameters(session, where);
  for (const std::string& change : changes) apply_setting(p, change);
  return p;
}

}  // namespace limpid
