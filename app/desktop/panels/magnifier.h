// The gap between device and proxy, as a number and through a lens in a corner of the 3D view.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>

#include "app/plot/plot_frame.h"
#include "render/camera.h"
#include "render/scene_view.h"

namespace limpid {

inline constexpr double kMagnified = 5;

// There is a gap or a contact, and it is small in a picture of this camera.
bool worth_magnifying(const ViewState& state, const Camera& camera);

// What it draws into.
struct LensPlace {
  ScreenRect view;         // the 3D view
  double pixel_scale = 1;  // pixels a point
  int pixel_height = 0;    // of the window [px]
  float words = 0;         // that words take at the view's top over all of its width [points]
};

// In the lower right corner, or in the upper one where it would hide the tips; where `words`, as in
// LensPlace, leave it no room there, in the lower left one. Nothing where the view is too small.
std::optional<ScreenRect> lens_corner(ScreenRect view, float words, ImVec2 tips);

class Magnifier {
 public:
  // Shows the lens, in OpenGL, while that is worth it and a moment longer.
  void draw(SceneView& picture, const ViewState& state, const Camera& camera,
            const LensPlace& place);
  // Frame, scale and what part of the picture it is, over that.
  void draw_frame(const ViewState& state, const Camera& camera, ImDrawList& list) const;
  void hide() { rect_.reset(); }
  const std::optional<ScreenRect>& rect() const { return rect_; }  // where it is, if it is shown

 private:
  std::optional<ScreenRect> rect_;
  ScreenRect view_{};
  double until_ = -1;  // ImGui's time [s]
};

}  // namespace limpid
