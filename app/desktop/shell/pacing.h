// Pacing of the window's frames: with the display if that sets the pace, and seldom if nothing
// happens.
#pragma once

#include <chrono>
#include <functional>
#include <span>

struct GLFWwindow;

namespace limpid {

using SteadyClock = std::chrono::steady_clock;

// Returns whether exchanging buffers waits for the display: empty `exchanges` take about as long as
// `refresh` [s], which is 0 if unknown.
bool display_paces(std::span<const double> exchanges, double refresh);

// Lets exchanges wait for the display, if they can. Returns the refresh then, else 0 [s]. `paint`
// draws what is shown until the first frame.
double pacing_refresh(GLFWwindow* window, const std::function<void()>& paint);

// Tells when a frame is needed though the 3D picture is the same: just after a touch, as widgets
// may still move, and now and then for numbers.
class Liveliness {
 public:
  void touch(SteadyClock::time_point now) { touched_ = now; }
  void drawn(SteadyClock::time_point now) { drawn_ = now; }
  bool due(SteadyClock::time_point now) const;

 private:
  SteadyClock::time_point touched_{}, drawn_{};
};

}  // namespace limpid
