// Signs of objects: names and icons of shapes, objects to add, and outlines in the view.
#pragma once

#include <imgui.h>

#include <vector>

#include "app/plot/plot_frame.h"
#include "core/touch/scene.h"
#include "render/camera.h"

namespace limpid {

const char* shape_name(const Shape& shape);  // for people

// Object that can be added without a file.
struct NewObject {
  const char* label;  // in a menu
  Object object;
  bool first_that_moves = false;
};
std::vector<NewObject> new_objects();

// Draws a small picture of a shape into the present window, of half the width r [px].
void draw_icon(const Shape& shape, ImVec2 middle, float r, ImU32 ink);

// Draws a selected object's outline over the view; not of meshes and stops of joints, whose picture
// shows the selection.
void draw_outline(const Object& object, const Camera& camera, ScreenRect view, ImDrawList& list);

}  // namespace limpid
