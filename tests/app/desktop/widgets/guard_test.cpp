#include <imgui.h>

#include <stdexcept>
#include <string>

#include "app/desktop/widgets/modal.h"
#include "tests/app/plot/imgui_frames.h"

namespace limpid {
namespace {

class Guard : public ImGuiFrames {
 protected:
  // Draws a frame in which `work` throws, and an ordinary one; ImGui asserts on unbalanced stacks.
  template <class Work>
  void survive(Work&& work) {
    for (int i = 0; i < 3; ++i) {
      heard.clear();
      frame([&] {
        ImGui::Begin("beside it");
        ImGui::End();
        guarded([this](const char* what) { heard = what; }, work);
        ImGui::Begin("beside it");
        shown = ImGui::GetFont() == ImGui::GetIO().Fonts->Fonts[0];
        ImGui::End();
      });
      EXPECT_EQ(heard, "no room on the disk");
      EXPECT_TRUE(shown) << "in the ordinary font";
    }
  }
  [[noreturn]] static void fail() { throw std::runtime_error("no room on the disk"); }

  std::string heard;
  bool shown = false;
};

TEST_F(Guard, PassesOnWhatDoesNotThrow) {
  bool done = false;
  frame([&] { guarded([this](const char* what) { heard = what; }, [&] { done = true; }); });
  EXPECT_TRUE(done);
  EXPECT_EQ(heard, "");
}

TEST_F(Guard, UnwindsWindowsChildrenGroupsTablesAndStyles) {
  survive([] {
    ImGui::Begin("panel");
    ImGui::PushFont(ImGui::GetFont());
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1, 0, 0, 1));
    ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 0.5f);
    ImGui::BeginDisabled();
    ImGui::BeginChild("list", {100, 100});
    ImGui::PushID("row");
    ImGui::BeginGroup();
    ImGui::BeginTable("table", 2);
    ImGui::TableNextColumn();
    ImGui::BeginTooltip();
    fail();
  });
}

TEST_F(Guard, UnwindsMenusInsideOfMenus) {
  survive([] {
    ImGui::BeginMainMenuBar();
    ImGui::OpenPopup("File");
    if (ImGui::BeginMenu("File")) {
      ImGui::OpenPopup("Recent");
      ImGui::BeginMenu("Recent");
    }
    fail();
  });
}

TEST_F(Guard, UnwindsDialogs) {
  survive([] {
    ImGui::OpenPopup("question");
    EXPECT_TRUE(ImGui::BeginPopupModal("question"));
    ImGui::BeginChild("folder");
    fail();
  });
}

}  // namespace
}  // namespace limpid
