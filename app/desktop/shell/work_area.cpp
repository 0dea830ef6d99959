#include "app/desktop/shell/work_area.h"

#include <algorithm>

#include "app/base/window_system.h"

namespace limpid {

WorkArea work_area() {
  WorkArea area;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (monitor == nullptr) return area;
  glfwGetMonitorWorkarea(monitor, &area.x, &area.y, &area.width, &area.height);
  float scale = 1, vertical = 1;
  glfwGetMonitorContentScale(monitor, &scale, &vertical);
  (on_wayland() ? area.density : area.scale) = scale;  // Wayland enlarges windows itself
  return area;
}

void move_into(const WorkArea& area, GLFWwindow* window) {
  int left = 0, top = 0, right = 0, bottom = 0, x = 0, y = 0, width = 0, height = 0;
  glfwGetWindowFrameSize(window, &left, &top, &right, &bottom);
  if (!on_wayland()) glfwGetWindowPos(window, &x, &y);
  glfwGetWindowSize(window, &width, &height);
  const int fit_width = std::min(width, area.width - left - right);
  const int fit_height = std::min(height, area.height - top - bottom);
  if (fit_width != width || fit_height != height) glfwSetWindowSize(window, fit_width, fit_height);
  if (on_wayland()) return;
  const auto held = [](int at, int low, int high) {
    return std::clamp(at, low, std::max(low, high));
  };
  const int fit_x = held(x, area.x + left, area.x + area.width - right - fit_width);
  const int fit_y = held(y, area.y + top, area.y + area.height - bottom - fit_height);
  if (fit_x != x || fit_y != y) glfwSetWindowPos(window, fit_x, fit_y);
}

}  // namespace limpid
