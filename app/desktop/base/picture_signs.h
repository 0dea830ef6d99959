// Words and numbers over the picture of arm and scene.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>

#include "app/desktop/base/plot_choice.h"
#include "app/plot/plot_frame.h"
#include "render/camera.h"
#include "render/view_state.h"

namespace limpid {

// A place in the picture, in pixels from its upper left corner, as one in the window.
ImVec2 in_window(ScreenRect picture, const Eigen::Vector2d& pixel);

// "gap 0.42 mm"; empty where there is none to speak of, below a hundredth of a millimetre.
std::string gap_text(double meters);
// Where the camera's picture is, and in it a lens that is to stay free.
struct GapPlace {
  ScreenRect picture;
  std::optional<ScreenRect> lens = {};
};
// At the two tips: how far apart they are. Of two runs in one picture each has its number, with its
// name.
void draw_gap(const ViewState& view, const Camera& camera, const GapPlace& at, ImDrawList& list,
              const RunNames& names = {});
// A line from the body that is pulled on to where it is pulled.
void draw_pull(const ViewState& view, const Camera& camera, ScreenRect picture, ImDrawList& list);
// A ring around the proxy's tip while its magnet is on, thick while that holds something.
void draw_magnet(const ViewState& view, const Camera& camera, ScreenRect picture, ImDrawList& list);
// A ring around the device's tip: the mouse has hold of it, or would have.
void draw_grasp(const ViewState& view, const Camera& camera, ScreenRect picture, ImDrawList& list);
// What the first or the second run of a twin is called, at the top of its half, with a sample of
// its curves.
void draw_run_name(const RunNames& names, bool second, ScreenRect half, ImDrawList& list);

// What must not be missed, at the top of a picture, or below the names of a twin's halves.
void draw_sign(const std::string& sign, ScreenRect picture, bool below_names, ImDrawList& list);

// A sentence at the bottom of a picture, in lines as they fit.
void draw_told(const std::string& told, ScreenRect picture, ImDrawList& list);

// The halves of a twin's picture.
ScreenRect half_of(ScreenRect picture, bool right);

}  // namespace limpid
