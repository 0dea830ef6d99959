// The story in the window: how it is begun, and how somebody takes over.
#pragma once

#include "app/desktop/base/settings.h"
#include "app/desktop/playback/playback.h"
#include "app/plot/plot_frame.h"

namespace limpid {

// A button of a first start, over its hint; true when it is pressed.
// `hinted`: there is one.
bool story_asked_for(const Playback& playback, const Settings& settings, ScreenRect view,
                     bool hinted);
// Somebody reaches into the picture of a story: the hand is theirs.
bool story_taken_over(const Playback& playback, ScreenRect view);

}  // namespace limpid
