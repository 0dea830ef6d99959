// An identification in a folder, for people and for other programs.
#pragma once

#include <filesystem>
#include <optional>

#include "app/device/device_hub.h"
#include "app/study/figure.h"
#include "app/study/identification.h"

namespace limpid {

// The arm that was found, as its file.
std::string identified_urdf(const Identification& identification);

// What the hub remembers of it.
DeviceHub::Profile profile_of(const Identification& identification);

// Where a folder has the motion, and the one with the load.
inline constexpr const char* kMotionFile = "motion.csv";
inline constexpr const char* kLoadedMotionFile = "motion-with-load.csv";
// As CSV. Errors: FileError.
void write_motion(const IdentifyRun& run, const std::filesystem::path& file);

// What explains the torques of each joint, its friction over its velocity, and how punctually the
// device reports.
Figure identify_figure(const Identification& identification);

// DIR/identified.urdf, .json (see findings_text()), .csv, .png, .svg and report.html, which names
// the motion's file; `last`: what was found before. Returns why there are no pictures, empty if
// there are. Errors: FileError.
std::string write_identification(const Identification& identification,
                                 const std::optional<Findings>& last,
                                 const std::filesystem::path& dir, const std::string& more = {});

}  // namespace limpid
