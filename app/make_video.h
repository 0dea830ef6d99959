// FFmpeg's libraries are many and large, and under another licence: a program of its own has them,
// `limpid-video`. It is all of limpid, with this function as make_video.cpp has it.
#pragma once

#include "app/cli/video_options.h"

namespace limpid {

// As MakeVideo says; `words` are the command line, which limpid hands on to limpid-video.
int make_video(const std::string& session, const VideoOptions& options, double text_scale,
               char** words);
// The same of a story's script.
int make_story_video(const std::string& script, const VideoOptions& options, char** words);

}  // namespace limpid
