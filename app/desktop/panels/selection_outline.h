// Where the selected object is, for those whose picture has no outline of its own.
#pragma once

#include <imgui.h>

#include "app/desktop/document/scene_editor.h"
#include "app/plot/plot_frame.h"
#include "render/camera.h"

namespace limpid {

// Draws planes, spheres and boxes as lines over the view.
void draw_outline(const SceneObject& object, const Camera& camera, ScreenRect view,
                  ImDrawList& list);

}  // namespace limpid
