// Recordings of plans, and the plan that a recording stands for.
#pragma once

#include "app/run/recorder.h"
#include "app/run/simulate.h"

namespace limpid {

// Returns what a recording of this plan says about itself.
SessionInfo session_info(const RunPlan& plan);
// Tells the recorder what each lane begins with, before the first row.
void tell_start(Recorder& recorder, const RunPlan& plan);

// Returns the parameters that a session began with. Errors: FileError.
Parameters session_parameters(const Session& session, const std::string& where);

// Returns a plan of the recorded hand in the recorded world, from the recorded first row. With the
// session's own parameters and world the run gives the same rows again, bit for bit. Changes made
// while recording are made again, except for keys that `chosen` sets otherwise than the session
// began. Errors: FileError if what the session says of itself cannot be read.
RunPlan replay(const Session& session, const std::string& where, const Parameters& chosen);

}  // namespace limpid
