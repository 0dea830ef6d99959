// Dialog that asks for the properties of a session's video.
#pragma once

#include <optional>

#include "app/desktop/playback/playback.h"

namespace limpid {

class VideoDialog {
 public:
  // Draws the dialog while `open`. Returns the request once it is made, and clears `open`.
  // `overlaid`: the window has all runs in one picture; `lens`: it has a lens.
  std::optional<VideoRequest> draw(bool& open, const Playback& playback, bool overlaid, bool lens);

 private:
  void draw_choices(const PlayedSession& session);
  void draw_span(const PlayedSession& session);
  double length() const { return (to_ - request_.from) / request_.speed; }  // of the video [s]

  VideoRequest request_;  // as it was the last time
  bool rerun_ = true;     // with the re-run, if there is one
  double to_ = 0;         // end in the session [s]
  bool was_shown_ = false;
};

}  // namespace limpid
