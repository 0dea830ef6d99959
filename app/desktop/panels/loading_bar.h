// How loading a scene or a model goes on.
#pragma once

#include "app/desktop/document/scene_loader.h"
#include "app/plot/plot_frame.h"

namespace limpid {

// At the foot of the view, while something is loaded.
void draw_loading(SceneLoader& loader, ScreenRect view);

}  // namespace limpid
