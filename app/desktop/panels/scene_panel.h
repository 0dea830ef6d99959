// The scene's objects: which there are, and what can be done with them.
#pragma once

#include <functional>
#include <optional>

#include "app/desktop/base/act.h"
#include "app/desktop/panels/object_editor.h"

namespace limpid {

class ScenePanel {
 public:
  using AddObject = std::function<void(Object)>;

  // The scene that is worked on, for this arm; in a recording it is `fixed`.
  void draw(Document& document, const ArmDescription& arm, bool fixed, const Act& act,
            const AddObject& add);
  // A recording's scene, which stays as it was.
  static void draw_recorded(const SceneDocument& document);

 private:
  ObjectEditor object_;
  std::optional<std::size_t> selected_;  // in the last frame
};

}  // namespace limpid
