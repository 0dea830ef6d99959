#include "app/desktop/shell/pacing.h"

#include <algorithm>
#include <array>

#include "app/base/window_system.h"

namespace limpid {
namespace {

constexpr auto kStirs = std::chrono::milliseconds(700);  // after a touch: hints fade, lists open
constexpr auto kBeat = std::chrono::milliseconds(500);   // for numbers while nothing moves
constexpr double kNearly = 0.7;                          // part of a refresh that counts as waiting

}  // namespace

bool display_paces(std::span<const double> exchanges, double refresh) {
  return refresh > 0 && !exchanges.empty() &&
         std::ranges::all_of(exchanges, [&](double t) { return t > kNearly * refresh; });
}

double pacing_refresh(GLFWwindow* window, const std::function<void()>& paint) {
  const auto exchange = [&] {
    paint();
    glfwSwapBuffers(window);
  };
  if (on_wayland()) {
    // Wayland tears nothing, and an exchange would wait while the window is hidden.
    glfwSwapInterval(0);
    exchange();
    return 0;
  }
  glfwSwapInterval(1);
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  const double refresh = mode != nullptr && mode->refreshRate > 0 ? 1.0 / mode->refreshRate : 0;
  exchange();  // the first exchanges do not wait
  exchange();
  std::array<double, 3> exchanges{};
  for (double& took : exchanges) {
    const double begin = glfwGetTime();
    exchange();
    took = glfwGetTime() - begin;
  }
  return display_paces(exchanges, refresh) ? refresh : 0;
}

bool Liveliness::due(SteadyClock::time_point now) const {
  return now - touched_ < kStirs || now - drawn_ >= kBeat;
}

}  // namespace limpid
