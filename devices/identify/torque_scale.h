// What a device's motors really give of what they are told. Motion alone cannot say: twice the
// torque on twice the inertia moves alike. Something known in kilograms does.
#pragma once

#include "devices/identify/fit.h"

namespace limpid {

// From a second motion with a small thing of so many kg fixed to the tip. `found`: of the first
// one, whose torques are what was told. Least squares for both motions at once: the same arm, and
// the load's torque, which is known, over the scale. Errors: std::invalid_argument where the load
// says too little.
Found torque_scale_by_load(const Identified& found, const MotionRecord& bare,
                           const MotionRecord& with_load, double mass, const FitSettings& settings);

// From the masses of the arm's file, where these are right: weighed, or of a careful drawing.
// Errors: likewise.
Found torque_scale_by_masses(const ArmDescription& file, const Identified& found,
                             const MotionRecord& record, const FitSettings& settings);

}  // namespace limpid
