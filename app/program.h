// The program `limpid`: runs a command and reports errors.
#pragma once

#include <string>

#include "app/cli/video_options.h"

namespace limpid {

// Functions that make videos; `words` is the command line.
struct VideoMakers {
  int (*of_session)(const std::string& session, const VideoOptions& options, double text_scale,
                    char** words);
  int (*of_story)(const std::string& script, const VideoOptions& options, char** words);
};

// Runs the command that the words name; returns the exit status.
int run_program(int argc, char** argv, const VideoMakers& videos);

}  // namespace limpid
