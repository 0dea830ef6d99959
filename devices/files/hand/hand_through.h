// A hand's path through points that somebody has chosen.
#pragma once

#include "devices/files/hand/hand_file.h"

namespace limpid {

// N >= 1 points and their times, increasing from 0 [m, s]. The hand holds all the while.
HandPath hand_through(std::vector<double> time, std::vector<Vec3> position, std::string source);

}  // namespace limpid
