// Magnifier of the gap between device and proxy: a number, and a lens in a corner of the 3D view.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>
#include <vector>

#include "app/plot/plot_frame.h"
#include "app/stage/free_place.h"
#include "render/camera.h"
#include "render/scene_view.h"

namespace limpid {

inline constexpr double kMagnified = 5;

// Returns whether there is a gap or a contact that is small in a picture of this camera.
bool worth_magnifying(const ViewState& state, const Camera& camera);

// Place that the lens is drawn in.
struct LensPlace {
  ScreenRect view;         // the 3D view
  double pixel_scale = 1;  // pixels per point
  int pixel_height = 0;    // height of the window [px]
  float words = 0;         // height of words at the view's top, over all of its width [points]
};

// Returns the lens's places, best first: the view's corners, the upper ones below `words` (see
// LensPlace). None if the view is too small.
std::vector<ScreenRect> lens_corners(ScreenRect view, float words);

class Magnifier {
 public:
  // Draws the lens in OpenGL, while it is worth it and a moment longer, where it covers the least.
  void draw(SceneView& picture, const ViewState& state, const Camera& camera,
            const LensPlace& place, const Crowd& crowd);
  // Draws frame, scale and magnification over the lens.
  void draw_frame(const ViewState& state, const Camera& camera, ImDrawList& list) const;
  void hide() { rect_.reset(); }
  const std::optional<ScreenRect>& rect() const { return rect_; }  // nothing if it is not shown

 private:
  std::optional<ScreenRect> rect_;
  FreePlace corner_;
  ScreenRect view_{};
  double until_ = -1;  // ImGui's time [s]
};

}  // namespace limpid
