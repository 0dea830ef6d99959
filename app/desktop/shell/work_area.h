// Where windows may be on the screen.
#pragma once

struct GLFWwindow;

namespace limpid {

inline constexpr int kLeastWidth = 900, kLeastHeight = 560;  // of a window

// The screen without the desktop's bars.
struct WorkArea {
  int x = 0, y = 0, width = kLeastWidth, height = kLeastHeight;
  float scale = 1;    // of the screen
  float density = 1;  // pixels for each of the window's units
};

// Of the first screen.
WorkArea work_area();

// Inside of the area with the frame that the desktop drew round the window.
void move_into(const WorkArea& area, GLFWwindow* window);

}  // namespace limpid
