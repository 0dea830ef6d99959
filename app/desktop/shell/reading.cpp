#include "app/desktop/shell/reading.h"

#include <imgui.h>

#include <algorithm>

#include "app/base/version.h"
#include "app/desktop/shell/commands.h"
#include "app/desktop/widgets/modal.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

// `width` [em]; `height`: part of the window's, 0: as the text needs. Pairs with ImGui::End().
void begin_reading(const char* title, float width, float height, bool& open) {
  const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {0.96f * room.x, 0.9f * room.y});
  ImGui::SetNextWindowSize(
      {std::min(width * ImGui::GetFontSize(), 0.96f * room.x), height * room.y});
  begin_dialog(title, open, ImGuiWindowFlags_NoResize);
  if (accepted()) open = false;
}

}  // namespace

void draw_help(bool& open) {
  if (!open) return;
  begin_reading("Keys and mouse", 46, 0.9f, open);
  ImGui::BeginChild("all", {0, -ImGui::GetFrameHeightWithSpacing()});
  if (ImGui::BeginTable("keys", 2)) {
    ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthFixed, 13 * ImGui::GetFontSize());
    for (const Shortcut& shortcut : shortcuts()) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(shortcut.keys.c_str());
      ImGui::TableNextColumn();
      ImGui::TextWrapped("%s", shortcut.what.c_str());
    }
    ImGui::EndTable();
  }
  ImGui::EndChild();
  close_button("Close (Esc)", open);
  ImGui::End();
}

void draw_about(bool& open) {
  if (!open) return;
  begin_reading("About Limpid", 34, 0, open);
  ImGui::PushFont(font(Face::semibold));
  ImGui::Text("Limpid %s", program_version());
  ImGui::PopFont();
  ImGui::TextWrapped(
      "Touch a virtual world through a haptic device and see, tick by tick, how transparent the "
      "coupling between hand and world is.");
  ImGui::Spacing();
  ImGui::TextWrapped(
      "The proposed coupling is that of \"Improving transparency of virtual coupling for haptic "
      "interaction with human force observer\"; numbers in parentheses are its equations. Please "
      "cite the paper when you publish what you measured here.");
  ImGui::Spacing();
  ImGui::TextWrapped(
      "Built on GLFW, Dear ImGui, Eigen, GLM, tinygltf, assimp, Draco, HDF5, urdfdom and fmt. Text "
      "is set in Inter (SIL Open Font License).");
  close_button("Close (Esc)", open);
  ImGui::End();
}

}  // namespace limpid
