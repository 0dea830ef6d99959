// How far the video of a session is.
#pragma once

#include "app/desktop/playback/playback.h"
#include "app/plot/plot_frame.h"

namespace limpid {

// At the top right of the view, while one is made.
void draw_video_bar(Playback& playback, ScreenRect view);

}  // namespace limpid
