// Words and numbers over the picture of arm and scene.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>

#include "app/plot/plot_frame.h"
#include "app/stage/free_place.h"
#include "app/stage/plot_choice.h"
#include "render/camera.h"
#include "render/view_state.h"

namespace limpid {

// Returns a pixel of the picture, counted from its upper left corner, as a place in the window.
ImVec2 in_window(ScreenRect picture, const Eigen::Vector2d& pixel);

// Returns "gap 0.42 mm", or an empty text below a hundredth of a millimetre.
std::string gap_text(double meters);
// Place of the camera's picture, and of a lens in it that stays free.
struct GapPlace {
  ScreenRect picture;
  std::optional<ScreenRect> lens = {};
};
// Draws the gap at the two tips. Runs in one picture have a number each, with its run's name.
void draw_gap(const ViewState& view, const Camera& camera, const GapPlace& at, ImDrawList& list,
              const RunNames& names = {});
// Keeps tips and what is pulled free of lens and cards, in the picture of this state.
void keep_acted_on_free(const ViewState& view, const Camera& camera, ScreenRect picture,
                        Crowd& crowd);

// Draws a line from the body that is pulled to the point it is pulled to, with the pull's force
// [N].
void draw_pull(const ViewState& view, double force, const Camera& camera, ScreenRect picture,
               ImDrawList& list);
// Draws a line from the device's tip to what is `below` it [m].
void draw_drop(const ViewState& view, double below, const Camera& camera, ScreenRect picture,
               ImDrawList& list);
// Draws a ring around the proxy's tip while its magnet is on, thick while the magnet holds
// something.
void draw_magnet(const ViewState& view, const Camera& camera, ScreenRect picture, ImDrawList& list);
// Draws a ring around the device's tip: the mouse has hold of it, then with the hand's force, or
// would have.
void draw_grasp(const ViewState& view, const Camera& camera, ScreenRect picture, ImDrawList& list);
// Draws a run's name at the top of its part of the picture, with a sample of its curves.
void draw_run_name(const RunNames& names, std::size_t run, ScreenRect part, ImDrawList& list);
// Room of these names from a picture's top on; legends begin below it [px].
float run_name_room();

// Draws a sign that must not be missed, at the top of a picture or below the names of its runs.
void draw_sign(const std::string& sign, ScreenRect picture, bool below_names, ImDrawList& list);

// Draws a sentence at the bottom of a picture, in as many lines as it needs.
void draw_told(const std::string& told, ScreenRect picture, ImDrawList& list);

// Returns the part of a picture that one of `runs` side by side has, from left to right.
ScreenRect part_of(ScreenRect picture, std::size_t run, std::size_t runs);

}  // namespace limpid
