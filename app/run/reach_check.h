// Whether the arm of a plan can go where its hand goes, before anything is run.
#pragma once

#include <string>

#include "app/run/simulate.h"

namespace limpid {

// What is out of reach, in words; empty if nothing is.
std::string out_of_reach(const RunPlan& plan);

}  // namespace limpid
