// Under which conditions an experiment's runs were made, for its caption.
#pragma once

#include <set>
#include <string>

#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"

namespace limpid {

// Gathers them from the runs themselves, so that none goes unsaid: arm, limit of the motors, grip,
// mass of the hand, encoders, delay and tick.
class Conditions {
 public:
  void add(const ArmDescription& arm, const Parameters& p);

  // "Conditions: ...", a sentence; empty without any run.
  std::string text() const;
  // The same without the hand, which is a person's, and what belongs to a simulated device.
  std::string of_the_device() const;

 private:
  std::string arms() const;
  std::string motors() const;

  std::set<std::string> arms_;
  std::set<int> joints_;
  std::set<double> own_limits_;  // of the arms whose motors are not limited otherwise [N m]
  std::set<double> limits_;      // of every motor [N m]
  std::set<double> grips_;       // [N/m]
  std::set<double> dampers_;     // of grips [N s/m]
  std::set<double> masses_;      // [kg]
  std::set<double> encoders_;    // [rad]
  std::set<double> delays_;      // [ms]
  std::set<double> ticks_;       // [ms]
};

}  // namespace limpid
