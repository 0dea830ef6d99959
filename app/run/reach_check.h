// Check before a run whether the arm of a plan can go where its hand goes.
#pragma once

#include <string>

#include "app/run/simulate.h"

namespace limpid {

// Says in words what is out of reach; empty if nothing is.
std::string out_of_reach(const RunPlan& plan);

}  // namespace limpid
