// What a video of the session that is played shall be like.
#pragma once

#include <optional>

#include "app/desktop/playback/playback.h"

namespace limpid {

class VideoDialog {
 public:
  // While `open`. What is to be made, once it is asked for; that clears `open`. `overlaid`: of a
  // twin both runs are in one picture in the window, too.
  std::optional<VideoRequest> draw(bool& open, const Playback& playback, bool overlaid);

 private:
  void draw_choices(const PlayedSession& session);
  void draw_span(const PlayedSession& session);
  double length() const { return (to_ - request_.from) / request_.speed; }  // of the video [s]

  VideoRequest request_;  // as it was the last time
  double to_ = 0;         // [s] of the session
  bool was_shown_ = false;
};

}  // namespace limpid
