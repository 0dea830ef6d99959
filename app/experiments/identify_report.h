// Reports of an identification: a folder for people and other programs.
#pragma once

#include <filesystem>
#include <optional>

#include "app/device/device_hub.h"
#include "app/experiments/identification.h"
#include "app/plot/figure.h"

namespace limpid {

// URDF of the identified arm.
std::string identified_urdf(const Identification& identification);

// Profile of the device for the hub.
DeviceHub::Profile profile_of(const Identification& identification);

// Names of the recorded motions in a folder; the second has the load at the tip.
inline constexpr const char* kMotionFile = "motion.csv";
inline constexpr const char* kLoadedMotionFile = "motion-with-load.csv";
// Writes a motion as CSV. Errors: FileError.
void write_motion(const IdentifyRun& run, const std::filesystem::path& file);

// Panels: torques of each joint and what explains them, friction over velocity, punctuality of the
// reports.
Figure identify_figure(const Identification& identification);

// Writes DIR/identified.urdf, .json (see findings_text()), .csv, .png, .svg and report.html, which
// names the motion's file. `last`: earlier findings to compare with. Returns why there are no
// pictures; empty if there are. Errors: FileError.
std::string write_identification(const Identification& identification,
                                 const std::optional<Findings>& last,
                                 const std::filesystem::path& dir, const std::string& more = {});

}  // namespace limpid
