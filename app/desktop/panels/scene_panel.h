// What can be changed about one object of the scene.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "app/desktop/base/notices.h"
#include "app/desktop/document/document.h"
#include "app/desktop/panels/parts_editor.h"

namespace limpid {

// A number with its label before it: dragged, or typed after a double click. True if it changed.
bool drag_number(const char* label, double& value, double speed, double least, double most,
                 const char* format, const char* help);

// Three numbers side by side under a label, dragged or typed after a double click.
bool drag3(const char* label, Vec3& values, double speed, double least, double most,
           const char* format, const char* help);
// What stands before a control, on its line.
void caption(const char* text, const char* help);

class ObjectEditor {
 public:
  void draw(Document& document, std::size_t place, const ArmDescription& arm);

 private:
  void draw_name(Document& document, std::size_t place);
  // Each says what was changed, "" for nothing.
  std::string_view edit(Object& object, Plane& plane);
  std::string_view edit(Object& object, Sphere& sphere);
  std::string_view edit(Object& object, Box& box);
  std::string_view edit(Object& object, Cylinder& cylinder);
  std::string_view edit(Object& object, Capsule& capsule);
  std::string_view edit(Object& object, Mesh& mesh);
  std::string_view edit(Object& object, JointStop& stop);
  std::string_view edit_placed(Object& object);

  std::string name_;     // being typed
  std::string name_of_;  // the object's it is
  RotationField rotation_;
  PartsEditor parts_;
  std::shared_ptr<const Model> measured_;  // a large one takes a while
  double extent_ = 0;                      // its largest [m]
  const ArmDescription* arm_ = nullptr;    // while drawing
};

// The scene's objects: which there are, and what can be done with them.
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
