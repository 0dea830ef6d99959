#include "app/desktop/scene/parts_editor.h"

#include <fmt/format.h>
#include <imgui.h>

#include <array>

#include "app/desktop/scene/scene_panel.h"
#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/words.h"
#include "devices/files/scene/scene_document.h"

namespace limpid {
namespace {

using namespace scene_limits;

struct PartShape {
  const char* name;
  Shape shape;  // of a new part
};
const std::array<PartShape, 4>& part_shapes() {
  static const std::array<PartShape, 4> all{
      PartShape{"ball", Sphere{0.01}}, PartShape{"box", Box{Vec3::Constant(0.02)}},
      PartShape{"cylinder", Cylinder{0.01, 0.02}}, PartShape{"capsule", Capsule{0.01, 0.02}}};
  return all;
}

const PartShape& part_shape(const Shape& shape) {
  for (const PartShape& each : part_shapes()) {
    if (each.shape.index() == shape.index()) return each;
  }
  return part_shapes()[0];
}

bool choose_part_shape(Shape& shape) {
  bool changed = false;
  caption("Shape", "A newly chosen shape begins with a size of 2 cm.");
  if (!ImGui::BeginCombo("##shape", part_shape(shape).name)) return false;
  for (const PartShape& each : part_shapes()) {
    const bool present = each.shape.index() == shape.index();
    if (!ImGui::Selectable(each.name, present) || present) continue;
    shape = each.shape;
    changed = true;
  }
  ImGui::EndCombo();
  return changed;
}

std::string_view edit_part(BodyPart& part, RotationField& rotation) {
  std::string_view what;
  if (choose_part_shape(part.shape)) what = "shape";
  if (const auto size = edit_size(part.shape); !size.empty()) what = size;
  Vec3 place = 1e3 * part.pose.translation();
  if (drag3("Position x, y, z [mm]", place, 0.25, 1e3 * kPosition.minimum, 1e3 * kPosition.maximum,
            "%.1f", "Measured from the object's middle, along the object's axes.")) {
    part.pose.translation() = 1e-3 * place;
    what = "place";
  }
  if (rotation.edit(part.pose)) what = "rotation";
  if (edit_color(part.color, "Off: the part has the object's colour.")) what = "color";
  return what;
}

}  // namespace

std::string PartsEditor::edit(Object& object) {
  std::string what;
  std::vector<BodyPart>& parts = object.parts;
  rotations_.resize(parts.size());
  heading("Parts");
  for (std::size_t i = 0; i < parts.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    const bool open = ImGui::TreeNode("##part", "%zu: %s", i + 1, part_shape(parts[i].shape).name);
    note_place(fmt::format("part {}", i + 1).c_str());
    if (open) {
      if (const auto changed = edit_part(parts[i], rotations_[i]); !changed.empty()) {
        what = fmt::format("part {} {}", i + 1, changed);
      }
      const bool remove = ImGui::Button("Remove part", {-1, 0});
      note_place("Remove part");
      tooltip("Ctrl+Z brings the part back.");
      if (remove) {
        what = fmt::format("part {} of {} removed", i + 1, parts.size());
        parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(i));
      }
      ImGui::TreePop();
      if (remove) rotations_.clear();
    }
    ImGui::PopID();
    if (rotations_.empty()) return what;
  }
  const bool add = ImGui::Button("Add part", {-1, 0});
  note_place("Add part");
  if (add) {
    parts.push_back({.shape = part_shapes()[0].shape});
    what = fmt::format("part {} added", parts.size());
  }
  tooltip("Adds a shape that is fixed to the object and moves with the object.");
  return what;
}

}  // namespace limpid
