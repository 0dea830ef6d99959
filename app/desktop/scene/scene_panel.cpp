#include "app/desktop/scene/scene_panel.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <utility>

#include "app/desktop/scene/body_editor.h"
#include "app/desktop/scene/object_signs.h"
#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/imgui_input.h"
#include "app/style/palette.h"
#include "app/style/range_reminder.h"
#include "app/style/sliders.h"
#include "app/style/theme.h"
#include "core/touch/triangle_mesh.h"
#include "devices/files/scene/scene_document.h"
#include "devices/files/scene/scene_fields.h"

namespace limpid {

void caption(const char* text, const char* help) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(text);
  tooltip(help);
  ImGui::SameLine(0.45f * ImGui::GetContentRegionMax().x);
  ImGui::SetNextItemWidth(-1);
}

bool drag3(const char* label, Vec3& values, double speed, double least, double most,
           const char* format, const char* help) {
  ImGui::TextUnformatted(label);
  tooltip(help);
  ImGui::SetNextItemWidth(-1);
  ImGui::PushID(label);
  Vec3 wanted = values;
  const bool changed = ImGui::DragScalarN("##v", ImGuiDataType_Double, wanted.data(), 3,
                                          static_cast<float>(speed), &least, &most, format);
  note_number_item();
  note_place(label);
  tooltip(help);
  const auto allowed = [&](double x) { return x >= least && x <= most; };
  const bool taken = counts(ImGui::GetID("##v"), changed, std::ranges::all_of(wanted, allowed),
                            fmt::format("{:g} to {:g}", least, most));
  ImGui::PopID();
  if (taken) values = wanted;
  return taken;
}

namespace {

using namespace scene_limits;

constexpr const char* kPositionLabel = "Position x, y, z [mm]";

bool position(Pose& pose, const char* label,
              const char* help =
                  "Distances forward, left and up from the arm's base. For an object that moves, "
                  "this is the position at the start.") {
  Vec3 millimetres = 1e3 * pose.translation();
  if (!drag3(label, millimetres, kMillimetreSpeed, 1e3 * kPosition.minimum, 1e3 * kPosition.maximum,
             "%.1f", help)) {
    return false;
  }
  pose.translation() = 1e-3 * millimetres;
  return true;
}

bool choose_material(Material& material) {
  bool changed = false;
  caption("Material", "A usual material as a starting point. The fields below show its values.");
  const UsualMaterial* const present = usual_material(material);
  if (!ImGui::BeginCombo("##material", present ? present->name : "its own")) return false;
  for (const UsualMaterial& each : kUsualMaterials) {
    if (!ImGui::Selectable(each.name, &each == present)) continue;
    material = each.material;
    changed = true;
  }
  ImGui::EndCombo();
  return changed;
}

// Returns the name of the change, "" for none.
std::string_view edit_material(Material& material) {
  std::string_view what;
  if (choose_material(material)) what = "material";
  if (const auto key = edit_fields(kMaterialFields, material); !key.empty()) what = key;
  return what;
}

// Edits unit and axes of the model's file.
bool choose_axes(Mesh& mesh) {
  bool changed = false;
  caption("Unit of the file",
          "Unit of the coordinates in the file. Many formats do not name the unit.");
  const ModelUnit* const present = model_unit(mesh.unit);
  if (ImGui::BeginCombo("##unit", present ? present->name : "")) {
    for (const ModelUnit& each : kModelUnits) {
      if (!ImGui::Selectable(each.name, &each == present)) continue;
      mesh.unit = each.metres;
      changed = true;
    }
    ImGui::EndCombo();
  }
  caption("Axis up", "The axis of the file that points up when no rotation is set.");
  int axis = mesh.y_up ? 0 : 1;
  if (ImGui::Combo("##up", &axis, "y\0z\0")) {
    mesh.y_up = axis == 0;
    changed = true;
  }
  return changed;
}

void draw_title(const SceneDocument& document) {
  const std::string title = document.title.empty() ? "untitled" : document.title;
  ImGui::TextUnformatted(title.c_str());
  tooltip(document.about.c_str());
}

void draw_why_fixed(const char* why) {
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("%s", why);
  ImGui::PopTextWrapPos();
}

// Draws the list of objects. `editor`: selects them; null: none can be selected. `fresh`: the
// selection is new.
void draw_list(const Scene& scene, SceneEditor* editor, bool fresh, const Act& act) {
  const std::vector<Object>& all = scene.objects;
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const auto lines = static_cast<float>(std::clamp<std::size_t>(all.size(), 1, 6));
  const float pad = 2 * ImGui::GetStyle().WindowPadding.y - ImGui::GetStyle().ItemSpacing.y;
  ImGui::BeginChild("objects", {0, lines * line + pad}, true, ImGuiWindowFlags_NoNav);
  if (all.empty()) ImGui::TextDisabled("Nothing to touch. Drop a model here.");
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Object& object = all[i];
    ImGui::PushID(static_cast<int>(i));
    const bool chosen = editor != nullptr && editor->selected() == i;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float em = ImGui::GetFontSize();
    if (chosen && fresh) ImGui::SetScrollHereY();
    const bool clicked =
        ImGui::Selectable("##object", chosen, ImGuiSelectableFlags_AllowDoubleClick);
    if (clicked && editor != nullptr) {
      const bool twice = ImGui::IsMouseDoubleClicked(0);
      editor->select(chosen && !twice ? std::nullopt : std::optional(i));
      if (twice) act("scene.look");
    }
    tooltip(fmt::format("{}, {}{}. Double click to look at it.", object.name,
                        shape_name(object.shape), object.body ? " that moves" : "")
                .c_str());
    draw_icon(object.shape, {at.x + 0.5f * em, at.y + 0.5f * em}, 0.33f * em,
              colour(current_palette().muted));
    ImGui::GetWindowDrawList()->AddText({at.x + 1.4f * em, at.y}, colour(current_palette().text),
                                        object.name.c_str());
    ImGui::PopID();
  }
  ImGui::EndChild();
}

void draw_buttons(bool any_selected, const Act& act, const ScenePanel::AddObject& add) {
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 size((ImGui::GetContentRegionAvail().x - 3 * gap) / 4, 0);
  if (ImGui::Button("Add", size)) ImGui::OpenPopup("add");
  tooltip("Adds an object to the scene.");
  ImGui::BeginDisabled(!any_selected);
  ImGui::SameLine();
  if (ImGui::Button("Copy", size)) act("scene.copy");
  tooltip("Adds a copy beside the object (Ctrl+D).");
  ImGui::SameLine();
  if (ImGui::Button("Remove", size)) act("scene.remove");
  tooltip("Removes the object (Delete). Ctrl+Z brings the object back.");
  ImGui::SameLine();
  if (ImGui::Button("Look", size)) act("scene.look");
  tooltip("Turns the camera to the object (double click).");
  ImGui::EndDisabled();
  if (ImGui::BeginPopup("add")) {
    if (ImGui::MenuItem("Model...", "Ctrl+M")) act("scene.add_model");
    for (const NewObject& each : new_objects()) {
      if (each.first_that_moves) ImGui::Separator();
      if (ImGui::MenuItem(each.label)) add(each.object);
    }
    ImGui::EndPopup();
  }
}

}  // namespace

bool drag_number(const char* label, double& value, double speed, double least, double most,
                 const char* format, const char* help) {
  caption(label, help);
  ImGui::PushID(label);
  double wanted = value;
  const bool changed = ImGui::DragScalar("##v", ImGuiDataType_Double, &wanted,
                                         static_cast<float>(speed), &least, &most, format);
  note_number_item();
  note_place(label);
  tooltip(help);
  const bool taken = counts(ImGui::GetID("##v"), changed, wanted >= least && wanted <= most,
                            fmt::format("{:g} to {:g}", least, most));
  ImGui::PopID();
  if (taken) value = wanted;
  return taken;
}

void ObjectEditor::draw(Document& document, std::size_t place, const ArmDescription& arm) {
  draw_name(document, place);
  arm_ = &arm;
  if (const auto& model = document.editor().models()[place]; model && model != measured_) {
    measured_ = model;
    extent_ = model->bounds().sizes().maxCoeff();
  }
  Object object = document.scene().objects[place];
  std::string what(std::visit([&](auto& shape) { return edit(object, shape); }, object.shape));
  const bool coloured =
      !has_shape<Mesh>(object) && !has_shape<JointStop>(object) && !has_shape<Plane>(object);
  if (coloured && edit_color(object.color, "Off: the object has the default colour."))
    what = "color";
  if (const auto moved = edit_body(object, document.scene(), place); !moved.empty()) what = moved;
  if (object.body) {
    if (const auto part = parts_.edit(object); !part.empty()) what = part;
  }
  if (!what.empty() && document.may_edit()) document.editor().set(place, std::move(object), what);
}

void ObjectEditor::draw_name(Document& document, std::size_t place) {
  const std::string& present = document.scene().objects[place].name;
  if (name_of_ != present) name_ = name_of_ = present;
  ImGui::SetNextItemWidth(-1);
  ImGui::InputText("##name", &name_);
  note_place("name");
  if (ImGui::IsItemDeactivated()) {
    if (document.may_edit()) document.editor().rename(place, name_);
    name_of_.clear();
  }
  tooltip("Its name");
}

std::string_view ObjectEditor::edit(Object& object, Plane& plane) {
  std::string_view what = edit_material(object.material);
  if (position(object.pose, "Point on the plane x, y, z [mm]",
               "The plane goes through this point.")) {
    what = "place";
  }
  if (drag3("Normal x, y, z", plane.normal, 0.01, -1, 1, "%.3f",
            "The normal of the plane. It points out of the material, into free space.")) {
    what = "normal";
  }
  return what;
}

// Edits an object's material, place, rotation and size.
std::string_view ObjectEditor::edit_placed(Object& object) {
  std::string_view what = edit_material(object.material);
  const bool ball = has_shape<Sphere>(object);
  if (position(object.pose, ball ? "Centre x, y, z [mm]" : kPositionLabel)) what = "place";
  if ((!ball || object.body) && rotation_.edit(object.pose)) what = "rotation";
  if (const auto size = edit_size(object.shape); !size.empty()) what = size;
  return what;
}

std::string_view ObjectEditor::edit(Object& object, Mesh& mesh) {
  std::string_view what = edit_placed(object);
  double millimetres = 1e3 * mesh.size() * extent_;
  if (drag_number("Scale", mesh.scale, 0.004 * mesh.scale, 1e-6, 1e4, "%.5g",
                  "1: the size in the model's file.")) {
    what = "scale";
  }
  if (drag_number("Largest extent", millimetres, kMillimetreSpeed, 0.1, 1e5, "%.1f mm",
                  "Sets the scale.") &&
      extent_ > 0) {
    mesh.scale = 1e-3 * millimetres / (mesh.unit * extent_);
    what = "scale";
  }
  if (choose_axes(mesh)) what = "axes";
  read_out("triangles", fmt::format("{}", mesh.triangles->triangles()), {}, mesh.model.c_str());
  const std::string health = mesh.triangles->health().text();
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("%s", health.empty() ? "A closed surface." : health.c_str());
  ImGui::PopTextWrapPos();
  return what;
}

std::string_view ObjectEditor::edit(Object& object, JointStop& stop) {
  std::string_view what;
  double& stiffness = object.material.stiffness;
  if (edit_value(kStopStiffness, stiffness, JointStop::kUsualStiffness)) what = "stiffness";
  const auto name = [this](int i) { return arm_->joints[static_cast<std::size_t>(i)].name; };
  if (ImGui::BeginCombo("joint", name(stop.joint).c_str())) {
    for (int i = 0; i < arm_->dof(); ++i) {
      if (ImGui::Selectable(fmt::format("{}##{}", name(i), i).c_str(), i == stop.joint)) {
        stop.joint = i;
        what = "joint";
      }
    }
    ImGui::EndCombo();
  }
  if (const auto key = edit_fields(kJointStopFields, stop); !key.empty()) what = key;
  bool above = stop.direction > 0;
  if (ImGui::Checkbox("stops motion above", &above)) {
    stop.direction = above ? 1 : -1;
    what = "side";
  }
  tooltip("On: stops motion above the angle. Off: stops motion below the angle.");
  return what;
}

void ScenePanel::draw_recorded(const SceneDocument& document) {
  draw_title(document);
  draw_why_fixed("The scene of the recording. This scene cannot be changed.");
  ImGui::BeginDisabled();
  draw_list(document.scene, nullptr, false, {});
  ImGui::EndDisabled();
}

void ScenePanel::draw(Document& document, const ArmDescription& arm, bool fixed, const Act& act,
                      const AddObject& add) {
  SceneEditor& editor = document.editor();
  draw_title(editor.document());
  if (editor.dirty()) {
    ImGui::SameLine();
    ImGui::TextDisabled("changed");
    tooltip("The scene has changes that are not saved. Ctrl+S saves the scene.");
  }
  if (fixed) draw_why_fixed("Cannot be changed while recording.");
  ImGui::BeginDisabled(fixed);
  const bool fresh = std::exchange(selected_, editor.selected()) != selected_;
  draw_list(editor.scene(), &editor, fresh, act);
  draw_buttons(editor.selected().has_value(), act, add);
  if (const auto place = editor.selected()) {
    ImGui::Separator();
    object_.draw(document, *place, arm);
    ImGui::Separator();
  }
  draw_springs(document);
  double tip = 1e3 * editor.scene().tip_radius;
  if (drag_number("Tip radius", tip, 0.05, 0, 50, "%.2f mm",
                  "Radius of the ball at the arm's tip that touches things; 0 is a point.")) {
    editor.set_tip_radius(1e-3 * tip);
  }
  const float width = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  if (ImGui::Button("Save scene", {width, 0})) act("scene.save");
  tooltip(
      "Saves the scene (Ctrl+S). If the scene came with Limpid, Limpid saves a copy and does not "
      "change the original.");
  ImGui::SameLine();
  if (ImGui::Button("Gallery...", {width, 0})) act("scene.gallery");
  tooltip("Shows pictures of the scenes that you can open (Ctrl+G).");
  ImGui::EndDisabled();
}

}  // namespace limpid
