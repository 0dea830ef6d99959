// Watch for chatter of the loop, its wall and its remedies.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <string>

#include "app/desktop/base/settings.h"
#include "app/desktop/coupling/chatter.h"
#include "app/desktop/live/live_stage.h"
#include "app/desktop/scene/document.h"

namespace limpid {

class ChatterWatch {
 public:
  struct Wall {
    std::size_t place;  // among the scene's objects
    std::string name;
    double stiffness;  // [N/m]
    double softer;     // that the law renders in theory, at most half of `stiffness` [N/m]
  };
  struct Found {
    std::size_t lane;
    Parameters parameters;     // of that lane
    std::optional<Wall> wall;  // none: the tip touches nothing of the scene, or a joint's stop
  };

  ChatterWatch(Settings& settings, LiveStage& live, Document& document)
      : settings_(settings), live_(live), document_(document) {}

  // Looks at new rows of the loop; to be called once a frame.
  void follow();
  // Returns the newest finding. It is kept for a while after the chatter ended, as letting go ends
  // it. A change of law or scene forgets it.
  const std::optional<Found>& found() const { return found_; }
  // Returns the finding as text: which wall, which law, by how much.
  std::string text() const;

  // Switches to the predictive law, or softens the wall. Precondition of both: found().
  void take_predictive();
  void soften_wall();
  void forget() { found_.reset(); }

 private:
  using Clock = std::chrono::steady_clock;

  void note_touch();
  void judge_from_now();
  std::optional<Wall> wall_of(const Parameters& p) const;
  bool is_over() const;

  Settings& settings_;
  LiveStage& live_;
  Document& document_;
  std::array<Chatter, kMostLanes> chatter_;
  const Stage* of_ = nullptr;                  // stage whose history was looked at
  std::array<Parameters, kMostLanes> judged_;  // settings under which each lane is judged
  std::optional<std::size_t> touched_;         // object touched last
  Clock::time_point touched_at_{};
  std::optional<Found> found_;
  Clock::time_point seen_{};
};

}  // namespace limpid
