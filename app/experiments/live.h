// Experiments on a real device in a human hand: what the hand is asked to do, and the results.
#pragma once

#include <functional>
#include <string>

#include "app/experiments/experiment.h"

namespace limpid {

struct LiveTrial {
  std::string name;  // of its session file: DIR/live-NAME/name.h5
  Parameters parameters;
  double seconds = 10;
  std::string instruction;
};

// Arm, scene and settings of a live experiment, and the functions that run its trials.
struct LiveLaboratory {
  ArmDescription arm;
  SceneDocument document;
  Parameters parameters;  // as requested; an experiment changes those that it varies
  // Leads the hand through a trial and returns its recording. Throws Cancelled; FileError;
  // std::runtime_error.
  std::function<Session(const LiveTrial&)> run;
  // Sets the stiffness of everything in the scene for the trials that follow [N/m].
  std::function<void(double stiffness)> stiffen;
};

struct LiveExperiment {
  const char* name;
  const char* about;  // one line
  Outcome (*run)(LiveLaboratory&);
};

// Name of its result files.
inline std::string live_name(const LiveExperiment& e) { return std::string("live-") + e.name; }

std::span<const LiveExperiment> live_experiments();

// Runs one and writes DIR/live-NAME.csv, .png, .svg and .json. Errors: as carry_out().
Outcome carry_out(const LiveExperiment& experiment, LiveLaboratory& lab,
                  const std::filesystem::path& dir);

// Felt inertia and damping along the arm's own motion. f1 is f1_hat without the observer's lag: its
// part along M(x1) a1 gives the inertia, each joint's part along v1 the damping. A steady push of
// each joint, and parts faster than a hand, are taken off.
struct Felt {
  double inertia = 0;       // over that of the model's M [-]
  Eigen::VectorXd damping;  // [N m s/rad]
};
Felt felt_of(const Session& s, const ArmDescription& arm);

// The tip's rms speed above 20 Hz while it touches [m/s].
double chatter_in_contact(const Session& s, const ArmDescription& arm);

}  // namespace limpid
