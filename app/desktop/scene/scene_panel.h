// Panel of the scene: its objects, and the editor of one object.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "app/desktop/base/notices.h"
#include "app/desktop/scene/document.h"
#include "app/desktop/scene/parts_editor.h"

namespace limpid {

// Edits a number with its label before it, by dragging, or by typing after a double click. Returns
// whether it changed.
bool drag_number(const char* label, double& value, double speed, double least, double most,
                 const char* format, const char* help);

// Edits three numbers side by side under a label, as drag_number() does.
bool drag3(const char* label, Vec3& values, double speed, double least, double most,
           const char* format, const char* help);
// Draws a text before a control, on its line.
void caption(const char* text, const char* help);

class ObjectEditor {
 public:
  void draw(Document& document, std::size_t place, const ArmDescription& arm);

 private:
  void draw_name(Document& document, std::size_t place);
  // Edits its shape. Returns the name of the change, "" for none, as all edit...() do.
  std::string_view edit(Object& object, Plane& plane);
  std::string_view edit(Object& object, Mesh& mesh);
  std::string_view edit(Object& object, JointStop& stop);
  template <class S>
  std::string_view edit(Object& object, S&) {
    return edit_placed(object);
  }
  std::string_view edit_placed(Object& object);

  std::string name_;     // while it is typed
  std::string name_of_;  // name of the object that name_ is for
  RotationField rotation_;
  PartsEditor parts_;
  std::shared_ptr<const Model> measured_;  // model of extent_, as a large one takes a while
  double extent_ = 0;                      // largest extent of the model [m]
  const ArmDescription* arm_ = nullptr;    // while drawing
};

// List of the scene's objects, with buttons and the editor of the selected one.
class ScenePanel {
 public:
  using AddObject = std::function<void(Object)>;

  // Draws the scene that is edited, for this arm; during a recording it is `fixed`.
  void draw(Document& document, const ArmDescription& arm, bool fixed, const Act& act,
            const AddObject& add);
  // Draws a recording's scene, which cannot be edited.
  static void draw_recorded(const SceneDocument& document);

 private:
  ObjectEditor object_;
  std::optional<std::size_t> selected_;  // as of the last frame
};

}  // namespace limpid
