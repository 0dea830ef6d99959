// Windows of GLFW, on X11 or on Wayland: GLFW has both since 3.4, and X11 alone before.
#pragma once

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cstdlib>

namespace limpid {

#ifdef GLFW_PLATFORM_WAYLAND
constexpr bool kKnowsWayland = true;
// Calls glfwInit(), without Wayland if none is named: its library would complain on stderr.
inline bool start_glfw() {
  const char* wayland = std::getenv("WAYLAND_DISPLAY");
  const bool named = wayland != nullptr && *wayland != '\0';
  glfwInitHint(GLFW_PLATFORM, named ? GLFW_ANY_PLATFORM : GLFW_PLATFORM_X11);
  return glfwInit() == GLFW_TRUE;
}
// Returns whether windows are on Wayland, once GLFW has started. On Wayland a program does not know
// where its windows are and cannot give them an icon: the desktop finds it by the app id.
inline bool on_wayland() { return glfwGetPlatform() == GLFW_PLATFORM_WAYLAND; }
#else
constexpr bool kKnowsWayland = false;
inline bool start_glfw() { return glfwInit() == GLFW_TRUE; }
inline bool on_wayland() { return false; }
#endif

// Sets the hints for the next window that is created.
inline void hint_window() {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
#ifdef GLFW_WAYLAND_APP_ID
  glfwWindowHintString(GLFW_WAYLAND_APP_ID, "limpid");  // limpid.desktop
#endif
}

}  // namespace limpid
