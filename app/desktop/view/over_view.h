// Signs over the picture: banners, notices, and work that goes on.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/desktop/base/notices.h"
#include "app/desktop/base/settings.h"
#include "app/desktop/playback/playback.h"
#include "app/desktop/scene/scene_loader.h"
#include "app/plot/plot_frame.h"
#include "app/stage/free_place.h"

namespace limpid {

struct Banner {
  struct Button {
    std::string label;
    const char* command;  // id of the command
  };
  const char* id;  // ImGui's id of its window
  std::string text;
  bool bad = false;
  std::vector<Button> buttons = {};
};

// Draws banners below each other from the top of the view, clear of the view's own `signs`. Returns
// the part of the view that banners and signs take.
ScreenRect draw_banners(std::span<const Banner> banners, ScreenRect view, ScreenRect signs,
                        const Act& act);

// Draws notices below banners and legend, or elsewhere in the view where they hide less: neither
// windows nor the crowd, as far as there is room.
class NoticeSigns {
 public:
  void draw(const Notices& notices, ScreenRect view, ScreenRect legend, const Crowd& crowd);

 private:
  FreePlace place_;
};

// Draws the progress of loading at the foot of the view. `recording`: what is loaded waits for the
// recording's end.
void draw_loading(SceneLoader& loader, bool recording, ScreenRect view);

// Draws the progress of a video at the top right of the view.
void draw_video_bar(Playback& playback, ScreenRect view);

// List of first steps, each ticked once it is done, in the corner of the view where it covers the
// least; closing it is enough of it.
class YourTurn {
 public:
  void draw(Settings& settings, ScreenRect view, const Crowd& crowd);
  void hide() { rect_.reset(); }
  const std::optional<ScreenRect>& rect() const { return rect_; }  // nothing if it is not shown

 private:
  FreePlace corner_;
  std::optional<ScreenRect> rect_;
  ImVec2 size_{};  // of the last frame
};

// Draws the button for the story of a first start, above the hints if they are at the foot. Returns
// true when it is pressed.
bool story_asked_for(const Playback& playback, const Settings& settings, ScreenRect view,
                     const std::optional<ScreenRect>& hinted);
// Returns true when the user reaches into the picture of a story, to take over the hand.
bool story_taken_over(const Playback& playback, ScreenRect view);

}  // namespace limpid
