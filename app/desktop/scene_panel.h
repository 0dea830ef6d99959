// The scene's objects: which there are, and what can be done with them.
#pragma once

#include "app/desktop/object_editor.h"
#include "app/desktop/workbench.h"

namespace limpid {

class ScenePanel {
 public:
  void draw(Workbench& bench);

 private:
  void draw_list(Workbench& bench, const Scene& scene);
  void draw_buttons(Workbench& bench);

  ObjectEditor object_;
};

}  // namespace limpid
