// Says that the loop chatters, at which wall, and what mends it.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <string>

#include "app/desktop/base/settings.h"
#include "app/desktop/document/document.h"
#include "app/desktop/live/chatter.h"
#include "app/desktop/live/live_session.h"

namespace limpid {

class ChatterWatch {
 public:
  struct Wall {
    std::size_t place;  // among the scene's objects
    std::string name;
    double stiffness;  // [N/m]
    double softer;     // that the law renders in theory, and no more than half of it [N/m]
  };
  struct Found {
    bool of_twin;
    Parameters parameters;  // of that run
    std::optional<Wall>
        wall;  // that the tip touches; none: nothing of the scene, or a joint's stop
  };

  ChatterWatch(Settings& settings, LiveSession& live, Document& document)
      : settings_(settings), live_(live), document_(document) {}

  // Once a frame, with the rows that the loop has made.
  void follow();
  // The newest finding, kept for a while after the chatter ended, as a hand that lets go ends it.
  // A change of law or scene forgets it.
  const std::optional<Found>& found() const { return found_; }
  // In words: which wall, which law, by how much.
  std::string text() const;

  // Precondition of these: found().
  void take_predictive();
  void soften_wall();
  void forget() { found_.reset(); }

 private:
  using Clock = std::chrono::steady_clock;

  void note_touch();
  std::optional<Wall> wall_of(const Parameters& p) const;
  bool is_over() const;
  const Parameters& run(bool twin) const {
    return twin ? settings_.twin.parameters : settings_.parameters;
  }

  Settings& settings_;
  LiveSession& live_;
  Document& document_;
  std::array<Chatter, 2> chatter_;      // of both runs
  const Stage* of_ = nullptr;           // whose history it looked at
  std::optional<std::size_t> touched_;  // the object that was touched last
  std::optional<Found> found_;
  Clock::time_point seen_{};
};

}  // namespace limpid
