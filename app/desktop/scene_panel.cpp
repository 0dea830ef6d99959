#include "app/desktop/scene_panel.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <numbers>
#include <string_view>

#include "app/desktop/panels.h"
#include "app/style/palette.h"
#include "app/style/parameter_slider.h"
#include "app/style/theme.h"
#include "core/geometry/triangle_mesh.h"
#include "devices/files/rpy.h"
#include "devices/files/scene_limits.h"

namespace limpid {
namespace {

using namespace scene_limits;
constexpr double kDegree = std::numbers::pi / 180;
constexpr float kMillimetreSpeed = 0.25f, kDegreeSpeed = 0.5f;  // per pixel of a drag

// A small picture of the kind, before the name.
void draw_icon(ObjectKind kind, const ImVec2& middle, float r, ImU32 ink) {
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const auto [x, y] = middle;
  const float thick = 1.4f * current_scale();
  switch (kind) {
    case ObjectKind::plane:
      draw->AddLine({x - r, y + 0.5f * r}, {x + r, y + 0.5f * r}, ink, 1.6f * thick);
      draw->AddLine({x, y + 0.4f * r}, {x, y - r}, ink, thick);
      break;
    case ObjectKind::sphere: draw->AddCircle(middle, r, ink, 20, thick); break;
    case ObjectKind::box: draw->AddRect({x - r, y - r}, {x + r, y + r}, ink, 0, 0, thick); break;
    case ObjectKind::mesh:
      draw->AddTriangle({x - r, y + r}, {x + r, y + r}, {x, y - r}, ink, thick);
      draw->AddTriangle({x - 0.5f * r, y}, {x + 0.5f * r, y}, {x, y + r}, ink, thick);
      break;
    case ObjectKind::joint_contact:
      draw->PathArcTo({x - r, y + r}, 1.8f * r, -1.57f, 0, 12);
      draw->PathStroke(ink, 0, thick);
      break;
  }
}

// Three numbers side by side, dragged or typed after a double click.
bool drag3(const char* label, Vec3& values, float speed, double least, double most,
           const char* format, const char* help) {
  ImGui::TextUnformatted(label);
  tooltip(help);
  ImGui::SetNextItemWidth(-1);
  ImGui::PushID(label);
  const bool changed = ImGui::DragScalarN("##v", ImGuiDataType_Double, values.data(), 3, speed,
                                          &least, &most, format, ImGuiSliderFlags_AlwaysClamp);
  ImGui::PopID();
  tooltip(help);
  return changed;
}

// A number with its label before it.
bool drag1(const char* label, double& value, float speed, double least, double most,
           const char* format, const char* help) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(label);
  tooltip(help);
  ImGui::SameLine(0.45f * ImGui::GetContentRegionMax().x);
  ImGui::SetNextItemWidth(-1);
  ImGui::PushID(label);
  const bool changed = ImGui::DragScalar("##v", ImGuiDataType_Double, &value, speed, &least, &most,
                                         format, ImGuiSliderFlags_AlwaysClamp);
  ImGui::PopID();
  tooltip(help);
  return changed;
}

bool position(const char* label, Vec3& point, const char* help) {
  Vec3 millimetres = 1e3 * point;
  if (!drag3(label, millimetres, kMillimetreSpeed, 1e3 * kPosition.minimum, 1e3 * kPosition.maximum,
             "%.1f", help)) {
    return false;
  }
  point = 1e-3 * millimetres;
  return true;
}

bool position(Pose& pose) {
  Vec3 at = pose.translation();
  const bool changed =
      position("Position x, y, z [mm]", at, "Forward, left and up from the arm's base.");
  pose.translation() = at;
  return changed;
}

bool stiffness(double& value, bool joint = false) {
  const ParameterInfo info{
      .key = "stiffness",
      .label = "Stiffness",
      .field = &Parameters::eta,
      .unit = joint ? "N m/rad" : "N/m",
      .minimum = 1e-3,
      .maximum = kStiffness.maximum,
      .slider_minimum = joint ? 0.1 : 1,
      .slider_maximum = joint ? 1e3 : 1e4,
      .logarithmic = true,
      .live = true,
      .meaning = "",
  };
  const bool changed =
      value_slider(info, value, joint ? JointContact{}.stiffness : Plane{}.stiffness);
  tooltip(
      "How hard it pushes back. Double click to type, right click for the usual value. A hard "
      "surface is felt as hard as the coupling lets through.");
  return changed;
}

double round_to(double x, double step) { return std::round(x / step) * step; }

}  // namespace

void ScenePanel::draw(Workbench& bench) {
  const bool fixed = bench.playing_back() || bench.live.recording();
  const Scene& scene = bench.playing_back() ? bench.playback->scene : bench.editor.scene();
  const std::string title = scene.title.empty() ? "untitled" : scene.title;
  ImGui::TextUnformatted(title.c_str());
  tooltip(scene.about.c_str());
  if (bench.editor.dirty() && !bench.playing_back()) {
    ImGui::SameLine();
    ImGui::TextDisabled("changed");
    tooltip("There are changes that are not saved. Ctrl+S saves them.");
  }
  if (fixed) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextDisabled("%s", bench.playing_back() ? "The recording's scene; it stays as it was."
                                                   : "Cannot be changed while recording.");
    ImGui::PopTextWrapPos();
  }
  ImGui::BeginDisabled(fixed);
  draw_list(bench, scene);
  if (!bench.playing_back()) {
    draw_buttons(bench);
    if (const auto ref = bench.editor.selected()) {
      ImGui::Separator();
      draw_name(bench, *ref);
      draw_object(bench, *ref);
      ImGui::Separator();
    }
    double tip = 1e3 * scene.tip_radius;
    if (drag1("Tip radius", tip, 0.05f, 0, 50, "%.2f mm",
              "The ball at the arm's tip that touches; 0 is a point.")) {
      bench.editor.set_tip_radius(1e-3 * tip);
    }
    const float width = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    if (ImGui::Button("Save scene", {width, 0})) bench.save_scene();
    tooltip("Ctrl+S. A scene that came with Limpid is saved as your own.");
    ImGui::SameLine();
    if (ImGui::Button("Gallery...", {width, 0})) bench.show_gallery = true;
    tooltip("Ctrl+G: scenes to open, with pictures.");
  }
  ImGui::EndDisabled();
}

void ScenePanel::draw_list(Workbench& bench, const Scene& scene) {
  const std::vector<ObjectRef> all = objects_of(scene);
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const auto lines = static_cast<float>(std::clamp<std::size_t>(all.size(), 1, 6));
  const float pad = 2 * ImGui::GetStyle().WindowPadding.y - ImGui::GetStyle().ItemSpacing.y;
  ImGui::BeginChild("objects", {0, lines * line + pad}, true, ImGuiWindowFlags_NoNav);
  if (all.empty()) ImGui::TextDisabled("Nothing to touch. Drop a .glb here.");
  for (const ObjectRef& ref : all) {
    ImGui::PushID(static_cast<int>(ref.kind) * 1000 + static_cast<int>(ref.index));
    const bool chosen = !bench.playing_back() && bench.editor.selected() == ref;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float em = ImGui::GetFontSize();
    if (ImGui::Selectable("##object", chosen, ImGuiSelectableFlags_AllowDoubleClick)) {
      bench.editor.select(chosen && !ImGui::IsMouseDoubleClicked(0) ? std::nullopt
                                                                    : std::optional(ref));
      if (ImGui::IsMouseDoubleClicked(0)) bench.frame_selected();
    }
    tooltip(
        fmt::format("{}, {}. Double click to look at it.", name_of(scene, ref), kind_name(ref.kind))
            .c_str());
    draw_icon(ref.kind, {at.x + 0.5f * em, at.y + 0.5f * em}, 0.33f * em,
              colour(current_palette().muted));
    ImGui::GetWindowDrawList()->AddText({at.x + 1.4f * em, at.y}, colour(current_palette().text),
                                        name_of(scene, ref).c_str());
    ImGui::PopID();
  }
  ImGui::EndChild();
}

void ScenePanel::draw_buttons(Workbench& bench) {
  const bool any = bench.editor.selected().has_value();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 size((ImGui::GetContentRegionAvail().x - 3 * gap) / 4, 0);
  if (ImGui::Button("Add", size)) ImGui::OpenPopup("add");
  tooltip("Something more to touch.");
  ImGui::BeginDisabled(!any);
  ImGui::SameLine();
  if (ImGui::Button("Copy", size)) bench.duplicate_selected();
  tooltip("Another one beside it (Ctrl+D).");
  ImGui::SameLine();
  if (ImGui::Button("Remove", size)) bench.remove_selected();
  tooltip("Delete. Ctrl+Z brings it back.");
  ImGui::SameLine();
  if (ImGui::Button("Look", size)) bench.frame_selected();
  tooltip("Turns the camera to it (double click).");
  ImGui::EndDisabled();
  if (ImGui::BeginPopup("add")) {
    if (ImGui::MenuItem("Model (.glb, .gltf)...", "Ctrl+M")) bench.show_add_model = true;
    if (ImGui::MenuItem("Ball")) bench.add_object(Sphere{.name = "ball", .radius = 0.02});
    if (ImGui::MenuItem("Block")) {
      bench.add_object(Box{.name = "block", .size = Vec3::Constant(0.04)});
    }
    if (ImGui::MenuItem("Plane")) bench.add_object(Plane{.name = "plane"});
    if (ImGui::MenuItem("Joint stop")) {
      bench.add_object(JointContact{.name = "stop", .joint = 0, .angle = 0.6});
    }
    ImGui::EndPopup();
  }
}

void ScenePanel::draw_name(Workbench& bench, const ObjectRef& ref) {
  const std::string& present = name_of(bench.editor.scene(), ref);
  if (name_of_ != present) name_ = name_of_ = present;
  ImGui::SetNextItemWidth(-1);
  ImGui::InputText("##name", &name_);
  if (ImGui::IsItemDeactivated()) {
    if (bench.may_edit()) bench.editor.rename(ref, name_);
    name_of_.clear();
  }
  tooltip("Its name");
}

bool ScenePanel::draw_rotation(Pose& pose) {
  if (pose.linear() != turned_) {
    turned_ = pose.linear();
    degrees_ = (rpy_of(turned_) / kDegree * 1e6).array().round() / 1e6 + 0.0;  // no -0
  }
  if (!drag3("Rotation roll, pitch, yaw [\xC2\xB0]", degrees_, kDegreeSpeed, -360, 360, "%.1f",
             "About the fixed axes x, y and z, one after the other.")) {
    return false;
  }
  turned_ = settled(rotation(degrees_ * kDegree));
  pose.linear() = turned_;
  return true;
}

void ScenePanel::draw_object(Workbench& bench, const ObjectRef& ref) {
  SceneObject object = object_of(bench.editor.scene(), ref);
  std::string_view what;  // that was changed
  const auto changed = [&](bool yes, const char* name) {
    if (yes) what = name;
  };
  if (auto* plane = std::get_if<Plane>(&object)) {
    changed(stiffness(plane->stiffness), "stiffness");
    changed(position("Point on it x, y, z [mm]", plane->point, "The plane goes through it."),
            "place");
    changed(drag3("Normal x, y, z", plane->normal, 0.01f, -1, 1, "%.3f", "Out of the material."),
            "normal");
  } else if (auto* sphere = std::get_if<Sphere>(&object)) {
    changed(stiffness(sphere->stiffness), "stiffness");
    changed(position("Centre x, y, z [mm]", sphere->center,
                     "Forward, left and up from the arm's base."),
            "place");
    double radius = 1e3 * sphere->radius;
    changed(drag1("Radius", radius, kMillimetreSpeed, 0.1, 1e3, "%.1f mm", "Of the ball"),
            "radius");
    if (what == "radius") sphere->radius = 1e-3 * radius;
  } else if (auto* box = std::get_if<Box>(&object)) {
    changed(stiffness(box->stiffness), "stiffness");
    changed(position(box->pose), "place");
    changed(draw_rotation(box->pose), "rotation");
    Vec3 size = 1e3 * box->size;
    if (drag3("Size x, y, z [mm]", size, kMillimetreSpeed, 0.1, 1e4, "%.1f", "Full edges")) {
      box->size = 1e-3 * size;
      what = "size";
    }
  } else if (auto* mesh = std::get_if<MeshObstacle>(&object)) {
    changed(stiffness(mesh->stiffness), "stiffness");
    changed(position(mesh->pose), "place");
    changed(draw_rotation(mesh->pose), "rotation");
    const double usual = mesh->scale;
    double scale = mesh->scale;
    const Model& model = *bench.editor.models()[ref.index];
    const double extent = 1e3 * model.bounds().sizes().maxCoeff();
    double millimetres = scale * extent;
    changed(drag1("Scale", scale, static_cast<float>(0.004 * usual), 1e-6, 1e4, "%.5g",
                  "1: as large as its file says."),
            "scale");
    if (drag1("Largest extent", millimetres, kMillimetreSpeed, 0.1, 1e5, "%.1f mm",
              "Sets the scale.") &&
        extent > 0) {
      scale = millimetres / extent;
      what = "scale";
    }
    if (what == "scale") mesh->scale = scale;
    read_out("triangles", fmt::format("{}", mesh->shape->triangles()), {}, mesh->file.c_str());
    const std::string health = mesh->shape->health().text();
    ImGui::PushTextWrapPos(0);
    ImGui::TextDisabled("%s", health.empty() ? "A closed surface." : health.c_str());
    ImGui::PopTextWrapPos();
  } else if (auto* stop = std::get_if<JointContact>(&object)) {
    changed(stiffness(stop->stiffness, true), "stiffness");
    const ArmDescription& arm = bench.stage->arm();
    const auto joint_name = [&](int i) { return arm.joints[static_cast<std::size_t>(i)].name; };
    if (ImGui::BeginCombo("joint", joint_name(stop->joint).c_str())) {
      for (int i = 0; i < arm.dof(); ++i) {
        if (ImGui::Selectable(fmt::format("{}##{}", joint_name(i), i).c_str(), i == stop->joint)) {
          stop->joint = i;
          what = "joint";
        }
      }
      ImGui::EndCombo();
    }
    double angle = stop->angle / kDegree;
    if (drag1("Angle", angle, kDegreeSpeed, -360, 360, "%.1f\xC2\xB0", "Where it stops")) {
      stop->angle = round_to(angle * kDegree, 1e-9);
      what = "angle";
    }
    bool above = stop->direction > 0;
    if (ImGui::Checkbox("stops what goes above", &above)) {
      stop->direction = above ? 1 : -1;
      what = "side";
    }
    tooltip("Otherwise it stops what goes below the angle.");
  }
  if (!what.empty() && bench.may_edit()) {
    bench.editor.set(ref, std::move(object), std::string(what));
  }
}

}  // namespace limpid
