// Scale of the motors' torque: what they give over what they are told. Motion alone does not show
// it: twice the torque on twice the inertia moves alike. A mass known in kilograms does.
#pragma once

#include "devices/identify/fit.h"

namespace limpid {

// Finds the scale from a second motion with a load of `mass` [kg] fixed to the tip. `found` comes
// from the first motion, in units of the torque told. Least squares for both motions at once: the
// same arm, and the load's known torque over the scale. Errors: std::invalid_argument if the load
// says too little.
Found torque_scale_by_load(const Identified& found, const MotionRecord& bare,
                           const MotionRecord& with_load, double mass, const FitSettings& settings);

// Finds the scale from the masses in the arm's file, if these are right: weighed, or of a careful
// drawing. Errors: as torque_scale_by_load().
Found torque_scale_by_masses(const ArmDescription& file, const Identified& found,
                             const MotionRecord& record, const FitSettings& settings);

}  // namespace limpid
