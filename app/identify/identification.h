// What came of moving a device so that it shows what it is, for the command and the window alike.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "app/device/identify_run.h"
#include "devices/identify/fit.h"

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

}  // namespace limpid
