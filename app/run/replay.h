// Between plans and recordings: what a recording says of its plan, and the plan it stands for.
#pragma once

#include "app/run/recorder.h"
#include "app/run/simulate.h"

namespace limpid {

// What a recording of this plan says about itself.
SessionInfo session_info(const RunPlan& plan);
// And of what each of its lanes begins with, before the first row.
void tell_start(Recorder& recorder, const RunPlan& plan);

// The parameters a session began with. Errors: FileError.
Parameters session_parameters(const Session& session, const std::string& where);

// The recorded hand in the recorded world from the recorded first row. With the session's own
// parameters and world the run gives the same rows again, bit for bit: changes made while
// recording are made again, except for keys that `chosen` sets otherwise than the session began.
// Errors: FileError if what the session says of itself cannot be read.
RunPlan replay(const Session& session, const std::string& where, const Parameters& chosen);

}  // namespace limpid
