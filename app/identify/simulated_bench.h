// A device that is drawn at random and unlike its file, to try an identification on.
#pragma once

#include "app/identify/identification.h"
#include "devices/identify/unlike_device.h"

namespace limpid {

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
