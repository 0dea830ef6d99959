// Results of an identification, for the command and the window alike.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/device/identify_run.h"
#include "devices/identify/fit.h"
#include "devices/identify/unlikeness.h"

namespace limpid {

struct IdentifyRequest {
  ArmDescription guess;  // its axes and lengths are taken as they are
  FitSettings fit;
  ExcitationPlan plan;
  double load = 0;  // mass fixed to the tip for a second motion, which finds the motors' real
                    // torque [kg]; 0: none
  bool masses_right = false;  // the guess's masses are right; the real torque follows from them
  std::optional<std::uint64_t> seed = {};  // of a simulated device
};
inline constexpr double kLeastLoad = 0.001, kMostLoad = 1;  // [kg]

struct Identification {
  std::string device;
  IdentifyRequest order;
  IdentifyRun bare, with_load;
  std::optional<Found> torque_scale;    // real torque over commanded torque, if asked for
  Identified found;                     // in the motors' real torques
  std::vector<double> inertia_in_file;  // the guess's, of each joint, if found [kg m^2]
};

// Identifies from a complete run, and one with the load if there is one. Errors:
// std::invalid_argument, see identify() and torque_scale.h.
Identification identification(std::string device, const IdentifyRequest& order, IdentifyRun bare,
                              IdentifyRun with_load);

// A finding of each joint, as written and shown.
struct FindingInfo {
  const char* key;  // in JSON, in SI
  const char* label;
  const char* unit;
  double per_unit;  // value in SI of one `unit`
  Found JointFinding::*field;
};
inline constexpr std::array kFindings{
    FindingInfo{"inertia", "inertia", "g m^2", 1e-3, &JointFinding::inertia},
    FindingInfo{"weight", "weight", "mN m", 1e-3, &JointFinding::gravity},
    FindingInfo{"coulomb", "friction", "mN m", 1e-3, &JointFinding::coulomb},
    FindingInfo{"viscous", "damping", "mN m s/rad", 1e-3, &JointFinding::viscous},
    FindingInfo{"spring", "spring", "mN m/rad", 1e-3, &JointFinding::spring},
    FindingInfo{"offset", "offset", "mN m", 1e-3, &JointFinding::offset}};

// Sentences on the device's delay, its rate of reports and the torque of its motors.
std::string device_text(const Identification& identification);

// "1.23 +- 0.05", in the finding's unit.
std::string text_of(const Found& found, double per_unit);
// Replaces "+-" by the sign where it can be shown.
std::string with_plus_minus(std::string text);
// Why a run ended early, for people; `order`: the request it was made for.
std::string explain(const IdentifyRun& run, const IdentifyRequest& order);

// Findings as JSON, to be kept and compared with: device, arm, when, seconds, delay, torque_scale,
// joints, readings. `more`: further members, as JSON.
std::string findings_text(const Identification& identification, const std::string& more = {});

struct Findings {
  std::string when;  // ISO 8601, local
  std::vector<JointFinding> joints;
  Found delay;
};
// Reads findings_text(); nothing if `json` is no such text.
std::optional<Findings> read_findings(const std::string& json);

// A finding that differs from the last time.
struct Drift {
  std::string what;  // "joint_1 inertia"
  const char* unit;
  Found before, now;  // in `unit`
  bool certain;       // more than the deviations and 3 % explain
};
// Every finding that differs; none if the number of joints does.
std::vector<Drift> drift(const Findings& before, const Identification& now);

// A random device, unlike the file that describes it, to test an identification on.
struct SimulatedBench {
  std::string name;
  ArmDescription truth;
  Unlikeness unlikeness;  // has a torque scale only if the order has a load to find it by
};
SimulatedBench simulated_bench(const IdentifyRequest& order, unsigned seed);

// Moves the simulated device, with the order's load at the tip or without.
IdentifyRun move_simulated(const SimulatedBench& bench, const IdentifyRequest& order,
                           bool with_load, IdentifyProgress& progress);

}  // namespace limpid
