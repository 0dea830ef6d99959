// What came of moving a device so that it shows what it is, for the command and the window alike.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/device/identify_run.h"
#include "devices/identify/fit.h"
#include "devices/identify/unlikeness.h"

namespace limpid {

struct IdentifyRequest {
  ArmDescription guess;  // whose axes and lengths are taken as they are
  FitSettings fit;
  ExcitationPlan plan;
  double load = 0;  // fixed to the tip for a second motion, which finds what the motors really give
                    // [kg]; 0: none
  bool masses_right = false;  // the guess's: they find it
};
inline constexpr double kLeastLoad = 0.001, kMostLoad = 1;  // [kg]

struct Identification {
  std::string device;
  IdentifyRequest order;
  IdentifyRun bare, with_load;
  std::optional<Found> torque_scale;  // what the motors give of what they are told, where asked for
  Identified found;                   // in the torques that they give
  std::vector<double> inertia_in_file;  // the guess's, of each joint, where it was found [kg m^2]
};

// Of a run that is complete, and of one with the load where there is one. Errors:
// std::invalid_argument, see identify() and torque_scale.h.
Identification identification(std::string device, const IdentifyRequest& order, IdentifyRun bare,
                              IdentifyRun with_load);

// What is found of each joint, as it is written and shown.
struct FindingInfo {
  const char* key;  // in JSON, in SI
  const char* label;
  const char* unit;
  double per_unit;  // of SI
  Found JointFinding::*field;
};
inline constexpr std::array kFindings{
    FindingInfo{"inertia", "inertia", "g m^2", 1e-3, &JointFinding::inertia},
    FindingInfo{"weight", "weight", "mN m", 1e-3, &JointFinding::gravity},
    FindingInfo{"coulomb", "friction", "mN m", 1e-3, &JointFinding::coulomb},
    FindingInfo{"viscous", "damping", "mN m s/rad", 1e-3, &JointFinding::viscous},
    FindingInfo{"spring", "spring", "mN m/rad", 1e-3, &JointFinding::spring},
    FindingInfo{"offset", "offset", "mN m", 1e-3, &JointFinding::offset}};

// How late the device answers, how often it reports, and what its motors give, in sentences.
std::string device_text(const Identification& identification);

// "1.23 +- 0.05", in the finding's unit.
std::string text_of(const Found& found, double per_unit);
// The same with the sign, where it can be shown.
std::string with_plus_minus(std::string text);
// Why a run ended before its end, for people; `order`: its.
std::string explain(const IdentifyRun& run, const IdentifyRequest& order);

// What was found of a device, as it is kept: to be read again, and compared with.

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

// A device that is drawn at random and unlike its file, to try an identification on.
struct SimulatedBench {
  std::string name;
  ArmDescription truth;
  Unlikeness unlikeness;  // the torque's scale only where the order has a load that finds it
};
SimulatedBench simulated_bench(const IdentifyRequest& order, unsigned seed);

// Moves it, with the order's load at the tip or without.
IdentifyRun move_simulated(const SimulatedBench& bench, const IdentifyRequest& order,
                           bool with_load, IdentifyProgress& progress);

}  // namespace limpid
