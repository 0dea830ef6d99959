// When the window draws: with the display where that says when, and seldom where nothing happens.
#pragma once

#include <chrono>
#include <functional>
#include <span>

struct GLFWwindow;

namespace limpid {

using SteadyClock = std::chrono::steady_clock;

// Whether exchanging buffers waits for the display: the times of some empty exchanges are about as
// long as `refresh`, which is 0 where that is not known. [s]
bool display_paces(std::span<const double> exchanges, double refresh);

// Lets exchanges wait for the display, where it does that; the refresh then, else 0 [s]. `paint`:
// what is exchanged meanwhile, and seen until the first frame.
double pacing_refresh(GLFWwindow* window, const std::function<void()>& paint);

// Whether a frame has to be drawn though the 3D picture is the same: since somebody has just
// touched the window, whose widgets may still be moving, or for numbers that go on.
class Liveliness {
 public:
  void touch(SteadyClock::time_point now) { touched_ = now; }
  void drawn(SteadyClock::time_point now) { drawn_ = now; }
  bool due(SteadyClock::time_point now) const;

 private:
  SteadyClock::time_point touched_{}, drawn_{};
};

}  // namespace limpid
