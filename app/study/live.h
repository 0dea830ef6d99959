// Experiments on a real device in a human hand: what the hand is asked to do, and what comes of it.
#pragma once

#include <functional>
#include <string>

#include "app/study/experiment.h"

namespace limpid {

struct LiveTrial {
  std::string name;  // of its session file: DIR/live-NAME/name.h5
  Parameters parameters;
  double seconds = 10;
  std::string instruction;
};

// What a live experiment runs in.
struct LiveLaboratory {
  ArmDescription arm;
  SceneDocument document;
  Parameters parameters;  // as asked for; an experiment changes what it varies
  // Leads the hand through a trial and returns its recording. Throws Cancelled; FileError;
  // std::runtime_error.
  std::function<Session(const LiveTrial&)> run;
  // Another stiffness of all that can be touched, for the trials that follow [N/m].
  std::function<void(double stiffness)> stiffen;
};

struct LiveExperiment {
  const char* name;
  const char* about;  // one line
  Outcome (*run)(LiveLaboratory&);
};

// Of what it leaves: live-NAME.
inline std::string live_name(const LiveExperiment& e) { return std::string("live-") + e.name; }

std::span<const LiveExperiment> live_experiments();

// Runs one and writes DIR/live-NAME.csv, .png, .svg and .json. Errors: as carry_out().
Outcome carry_out(const LiveExperiment& experiment, LiveLaboratory& lab,
                  const std::filesystem::path& dir);

// What the hand feels of the arm along its own motion: of f1, which is f1_hat without the
// observer's lag, the part along M(x1) a1, and each joint's along v1; beside a steady push of each
// joint, and without what is faster than a hand.
struct Felt {
  double inertia = 0;       // by that of the model's M [-]
  Eigen::VectorXd damping;  // [N m s/rad]
};
Felt felt_of(const Session& s, const ArmDescription& arm);

// The tip's speed above 20 Hz while it touches, rms [m/s].
double chatter_in_contact(const Session& s, const ArmDescription& arm);

}  // namespace limpid
