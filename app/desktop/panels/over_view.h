// What stands over the picture: what cannot be missed, what was said, and work that goes on.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/desktop/base/notices.h"
#include "app/desktop/base/settings.h"
#include "app/desktop/document/scene_loader.h"
#include "app/desktop/playback/playback.h"
#include "app/plot/plot_frame.h"

namespace limpid {

struct Banner {
  struct Button {
    std::string label;
    const char* command;  // its id
  };
  const char* id;  // of its window
  std::string text;
  bool bad = false;
  std::vector<Button> buttons = {};
};

// One below the other from the top of the view on, clear of what it shows at its `signs`. Returns
// the part of the view that they and the signs take.
ScreenRect draw_banners(std::span<const Banner> banners, ScreenRect view, ScreenRect signs,
                        const Act& act);

// Below what banners and the legend take.
void draw_notices(const Notices& notices, ScreenRect view, ScreenRect legend);

// At the foot of the view, while something is loaded.
void draw_loading(SceneLoader& loader, ScreenRect view);

// At the top right of the view, while a video is made.
void draw_video_bar(Playback& playback, ScreenRect view);

// At the lower left of the view: what is worth trying, each with a tick once it was done; closing
// it is enough of it.
void draw_your_turn(Settings& settings, ScreenRect view);

// The story: a button of a first start, over its hint; true when it is pressed.
// `hinted`: there is one.
bool story_asked_for(const Playback& playback, const Settings& settings, ScreenRect view,
                     bool hinted);
// Somebody reaches into the picture of a story: the hand is theirs.
bool story_taken_over(const Playback& playback, ScreenRect view);

}  // namespace limpid
