// The arm that an experiment runs on, and the settings that this arm brings.
#pragma once

#include <string>

#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"

namespace limpid {

// An arm with settings that suit it: gains, and the encoder steps and the delay of its file, if
// these are wanted. An experiment changes the settings that it is about.
struct ExperimentArm {
  ArmDescription description;
  Parameters settings;
  std::string name = {};  // "touch with its readings"; empty: the built-in arm, as experiments
                          // promise their bounds for it
  bool readings = false;  // the settings have the encoder steps and the delay of its file

  bool built_in() const { return name.empty(); }
  // Names the arm at the beginning of a sentence: "Built-in arm", "Arm touch".
  std::string heading() const;
  // "paper's gains", or those that differ: "gains coupling.k_vc 4 N m/rad".
  std::string gains() const;
};

// The built-in arm with the paper's settings. Errors: FileError.
ExperimentArm built_in_arm();

// An arm with the settings that its file suggests; with `readings` also the encoder steps and the
// delay of its file. The built-in arm without them is built_in_arm(). Errors: FileError.
ExperimentArm experiment_arm(const ArmDescription& arm, bool readings);

// Whether the tip of an arm moves over joints of the same names as the built-in arm's does: then
// scenes that name joints, and hands that turn a single one, suit it.
bool moves_as_built_in(const ArmDescription& arm);

}  // namespace limpid
