// What was found of a device, as it is kept: to be read again, and compared with.
#pragma once

#include <string>
#include <vector>

#include "app/identify/identification.h"

namespace limpid {

// JSON: device, arm, when, seconds, delay, torque_scale, joints, readings. `more`: other members,
// as JSON; empty: none.
std::string findings_text(const Identification& identification, const std::string& more = {});

struct Findings {
  std::string when;  // ISO 8601, local
  std::vector<JointFinding> joints;
  Found delay;
};
// Nothing where it is not such a text.
std::optional<Findings> read_findings(const std::string& json);

// A figure that is other than the last time.
struct Drift {
  std::string what;  // "joint_1 inertia"
  const char* unit;
  Found before, now;  // in that unit
  bool certain;       // more than their deviations and 3 % would make
};
// Every figure; none where it is another number of joints.
std::vector<Drift> drift(const Findings& before, const Identification& now);

}  // namespace limpid
