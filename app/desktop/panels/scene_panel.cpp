#include "app/desktop/panels/scene_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "app/desktop/panels/object_signs.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

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

// `editor`: where they can be chosen; null: they cannot. `fresh`: what is chosen was not before.
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
    tooltip(
        fmt::format("{}, {}. Double click to look at it.", object.name, shape_name(object.shape))
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
  tooltip("Something more to touch.");
  ImGui::BeginDisabled(!any_selected);
  ImGui::SameLine();
  if (ImGui::Button("Copy", size)) act("scene.copy");
  tooltip("Another one beside it (Ctrl+D).");
  ImGui::SameLine();
  if (ImGui::Button("Remove", size)) act("scene.remove");
  tooltip("Delete. Ctrl+Z brings it back.");
  ImGui::SameLine();
  if (ImGui::Button("Look", size)) act("scene.look");
  tooltip("Turns the camera to it (double click).");
  ImGui::EndDisabled();
  if (ImGui::BeginPopup("add")) {
    if (ImGui::MenuItem("Model...", "Ctrl+M")) act("scene.add_model");
    for (const NewObject& each : new_objects()) {
      if (ImGui::MenuItem(each.label)) add(each.object);
    }
    ImGui::EndPopup();
  }
}

}  // namespace

void ScenePanel::draw_recorded(const SceneDocument& document) {
  draw_title(document);
  draw_why_fixed("The recording's scene; it stays as it was.");
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
    tooltip("There are changes that are not saved. Ctrl+S saves them.");
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
  double tip = 1e3 * editor.scene().tip_radius;
  if (drag_number("Tip radius", tip, 0.05, 0, 50, "%.2f mm",
                  "The ball at the arm's tip that touches; 0 is a point.")) {
    editor.set_tip_radius(1e-3 * tip);
  }
  const float width = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  if (ImGui::Button("Save scene", {width, 0})) act("scene.save");
  tooltip("Ctrl+S. A scene that came with Limpid is saved as your own.");
  ImGui::SameLine();
  if (ImGui::Button("Gallery...", {width, 0})) act("scene.gallery");
  tooltip("Ctrl+G: scenes to open, with pictures.");
  ImGui::EndDisabled();
}

}  // namespace limpid
