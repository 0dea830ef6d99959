// The video of a recorded session.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/film/film_frame.h"
#include "app/story/story.h"
#include "app/video/video_file.h"
#include "devices/files/session/session.h"

namespace limpid {

struct FilmOrder {
  std::filesystem::path out = {};
  bool force = false;
  FilmLook look = {};
  std::optional<int> fps = {};        // none: what is usual for such a file
  double from = 0;                    // [s] of the session
  std::optional<double> to = {};      // none: its end
  double speed = 1;                   // of the session in the video, 0.01 to 100
  std::string title = {};             // at the right of the caption
  std::vector<StoryStep> steps = {};  // of the story that was recorded; none: it is no story's
};

// Moments of a session, one for each picture of its video.
struct FilmCut {
  double from, to;  // [s] of the session, in it, from < to
  double speed;
  int fps;

  double duration() const { return (to - from) / speed; }  // of the video [s]
  std::size_t pictures() const;                            // duration x fps, one at least
  double time(std::size_t picture) const;                  // [s] of the session
};

// What an order means for a session. Errors: FileError for times that are not in it, and for a
// name that is no video's.
FilmCut cut(const FilmOrder& order, const Session& session, const std::string& where);

struct FilmEnd {
  bool stopped = false;  // then there is no video
  double seconds = 0;    // of the video that were drawn
};

// Draws at full quality, as fast as it goes. `at` is told the part of the work that is done, 0
// to 1. `where` names the session in errors: FileError for what is refused before anything is
// written, else std::runtime_error.
FilmEnd film(const Session& session, const std::string& where, const FilmOrder& order,
             const std::atomic<bool>& stop, const std::function<void(double)>& at);

}  // namespace limpid
