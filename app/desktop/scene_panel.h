// The scene's objects: which there are, and what can be changed about the selected one.
#pragma once

#include <string>

#include "app/desktop/workbench.h"

namespace limpid {

class ScenePanel {
 public:
  void draw(Workbench& bench);

 private:
  void draw_list(Workbench& bench, const Scene& scene);
  void draw_buttons(Workbench& bench);
  void draw_name(Workbench& bench, const ObjectRef& ref);
  void draw_object(Workbench& bench, const ObjectRef& ref);
  bool draw_rotation(Pose& pose);

  std::string name_;            // being typed
  std::string name_of_;         // the object's it is
  Mat3 turned_ = Mat3::Zero();  // the rotation that `degrees_` stand for
  Vec3 degrees_ = Vec3::Zero();
};

}  // namespace limpid
