// How each shape is called, added and drawn: in the list of objects, and in the view.
#pragma once

#include <imgui.h>

#include <vector>

#include "app/plot/plot_frame.h"
#include "core/touch/scene.h"
#include "render/camera.h"

namespace limpid {

const char* shape_name(const Shape& shape);  // for people

// What can be added without a file.
struct NewObject {
  const char* label;  // in a menu
  Object object;
  bool first_that_moves = false;
};
std::vector<NewObject> new_objects();

// A small picture of a shape into the window that is being drawn, of half a width r [px].
void draw_icon(const Shape& shape, ImVec2 middle, float r, ImU32 ink);

// Where a selected object is, as lines over the view; meshes and stops of joints have a picture
// that shows it.
void draw_outline(const Object& object, const Camera& camera, ScreenRect view, ImDrawList& list);

}  // namespace limpid
