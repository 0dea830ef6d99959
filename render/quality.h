// Levels of quality: how much work a picture may be.
#pragma once

#include <cstddef>
#include <string_view>

namespace limpid {

struct Quality {
  int msaa = 4;            // samples a pixel; 1: edges are smoothed in the finished picture
  int shadow_size = 2048;  // edge of the shadow map in texels; 0: no shadows
  bool soft = true;        // wide, soft shadow edges
  double scale = 1;        // resolution of the 3D picture, which is scaled up where it is below 1
  std::size_t triangles = 8'000'000;  // most in sight; with more, large models are drawn coarsely

  // Levels run from the best, 0, to the fastest, kLowest; level() takes other numbers to the
  // nearest of these.
  static constexpr int kLowest = 5;
  static Quality level(int level);

  // Returns the level that suits the renderer named by GL_RENDERER: lower for drawing in software.
  static int automatic_level(std::string_view gl_renderer);
  static Quality automatic(std::string_view gl_renderer) {
    return level(automatic_level(gl_renderer));
  }
};

// Finds the level that a machine can draw, from the time its frames take:
//
//   AutoQuality automatic(Quality::automatic_level(renderer));
//   if (automatic.frame(seconds)) view.set_quality(Quality::level(automatic.level()));
//
// A second in which most frames are slower than 25 ms takes it a level down; several seconds in
// which nearly all are faster than 17.5 ms (a 60 Hz screen's frames are) take it up. Each step
// down doubles the seconds it waits before the next step up, so it settles.
class AutoQuality {
 public:
  explicit AutoQuality(int level = 0);

  // Takes the time of one frame [s], waiting for the screen included or not. Returns true at a new
  // level.
  bool frame(double seconds);
  int level() const { return level_; }
  // Forgets what was learnt about waiting, as something else is drawn now.
  void reset();

 private:
  void begin_second();

  int level_;
  double elapsed_ = 0;                    // of the second under way [s]
  int frames_ = 0, slow_ = 0, fast_ = 0;  // in that second
  int good_seconds_ = 0;                  // in a row
  int wait_;                              // good seconds before a step up
};

}  // namespace limpid
