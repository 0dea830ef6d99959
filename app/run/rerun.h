// Re-run: a recording's hand once more, under other settings.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "app/run/replay.h"
#include "core/base/large_memory.h"

namespace limpid {

// Settings from a row on.
struct SettingsFrom {
  std::uint64_t row = 0;
  Parameters parameters;
};

// Rows of a re-run.
// Figures by which people compare runs, as Summary has them.
struct RunFigures {
  std::string name;
  double error = 0, contact = 0;  // largest |x_E| and |f2|, in the units below
  double energy = 0;              // highest E_c [J]
  const char *error_unit = "mrad", *contact_unit = "N m";
};

struct RerunRows {
  ArmDescription arm;
  LargeVector<double> rows;            // as many as the session's; none if it was stopped
  RunEnd end;                          // after a divergence the last row is repeated
  std::vector<SettingsFrom> settings;  // from the first row on
  double at_limit = 0;                 // time in which a motor was at its limit [s]
  std::vector<std::string> cautions;   // RunWatch::cautions()
  std::string name;                    // "re-run: predictive", by what was changed
  std::string recorded;                // "recorded: standard", the first run's name beside it
  RunFigures figures, recorded_figures;
  std::string note;  // why it may differ from the recording; for people
};

// Runs the session's hand again under `chosen` for all settings that may change. Tells `at` the
// part that is done, 0 to 1. Errors: as replay().
RerunRows run_once_more(const Session& session, const std::string& where, const Parameters& chosen,
                        const std::atomic<bool>& stop, const std::function<void(double)>& at);

// Returns the settings of a re-run that differ from the session's, as "coupling.eta=0.5".
std::vector<std::string> changed_settings(const Session& session, const std::string& where,
                                          const Parameters& chosen);
// Returns the session's settings with these changes. Errors: FileError, ParameterError.
Parameters with_changes(const Session& session, const std::string& where,
                        const std::vector<std::string>& changes);

}  // namespace limpid
