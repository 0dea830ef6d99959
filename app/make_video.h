// Makes videos in a program of its own, `limpid-video`: it is limpid with these functions as in
// make_video.cpp. FFmpeg's libraries are many, large and under another licence.
#pragma once

#include "app/cli/video_options.h"

namespace limpid {

// Makes a session's video, see MakeVideo; `words`: the command line, which limpid passes on to
// limpid-video.
int make_video(const std::string& session, const VideoOptions& options, double text_scale,
               char** words);
// Makes the video of a story's script likewise.
int make_story_video(const std::string& script, const VideoOptions& options, char** words);

}  // namespace limpid
