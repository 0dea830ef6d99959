// The stiffest wall that a coupling renders well, found by tapping.
#pragma once

#include <span>
#include <vector>

#include "app/experiments/tap_bench.h"

namespace limpid {

// What a wall that is rendered well does not exceed.
struct WellRendered {
  static constexpr double kPort = 5e-5;     // given to the human [J]
  static constexpr double kEnergy = 5e-5;   // E_c, with exact encoders [J]
  static constexpr double kChatter = 0.02;  // [m/s]
  static constexpr double kFelt = 0.05;     // off the stiffness set, of it [-]
};
bool well_rendered(const Touch& touch, bool exact_encoder);

inline constexpr double kSoftest = 100, kStiffest = 20000;  // walls that are tried [N/m]
inline constexpr double kGrips[] = {300, 3000};             // hands that a wall has to stand [N/m]
inline constexpr int kBisections = 6;

// For each setting the stiffest wall [N/m] within kSoftest and kStiffest, by bisection of its
// logarithm; kSoftest if not even that one is rendered well. All settings go on side by side.
std::vector<double> stiffest_walls(Laboratory& lab, std::span<const TapSetting> settings);

}  // namespace limpid
