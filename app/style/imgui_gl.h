// ImGui drawing with OpenGL, in Limpid's fonts and colours: the same for windows and for videos.
#pragma once

#include "app/style/theme.h"

namespace limpid {

// An ImGui context. ImGui has one current context in all of a program: have one of these at a time,
// on one thread.
class ImGuiGl {
 public:
  // Needs a current OpenGL context until the end. Fonts and theme come with set_up().
  ImGuiGl();
  ~ImGuiGl();
  ImGuiGl(const ImGuiGl&) = delete;
  ImGuiGl& operator=(const ImGuiGl&) = delete;

  // `scale` 1 for ordinary screens; `density` pixels for each of ImGui's units.
  static void set_up(Theme theme, float scale, float density = 1);
  // Changes that between two frames.
  static void change(Theme theme, float scale, float density = 1);
  static void begin_frame();  // before ImGui::NewFrame()
  static void render();       // ends ImGui's frame and draws it over what is there
};

}  // namespace limpid
