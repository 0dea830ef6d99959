#include <gtest/gtest.h>
#include <imgui_internal.h>

#include "app/style/words.h"
#include "tests/app/plot/imgui_frames.h"

namespace limpid {
namespace {

class ATooltip : public ImGuiFrames {
 protected:
  // The tooltip of a panel's item once its size is known, with the mouse on the item.
  ImRect of_item(const ImRect& panel, const ImRect& item) {
    const ImGuiWindow* shown = nullptr;
    for (int i = 0; i < 4; ++i) {
      show_mouse(item.GetCenter());
      frame([&] {
        ImGui::SetNextWindowPos(panel.Min);
        ImGui::SetNextWindowSize(panel.GetSize());
        ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
        ImGui::SetCursorScreenPos(item.Min);
        ImGui::InvisibleButton("item", item.GetSize());
        tooltip("What this is, in a sentence that is long enough for more than one line of text.");
        ImGui::End();
      });
      shown = ImGui::FindWindowByName("##Tooltip_00");
    }
    EXPECT_NE(shown, nullptr);
    return shown != nullptr ? shown->Rect() : ImRect();
  }
};

TEST_F(ATooltip, CoversNeitherItsItemNorItsPanelAndStaysInTheWindow) {
  const ImRect left({0, 20}, {250, 400}), right({560, 20}, {800, 400});
  for (const ImRect& panel : {left, right}) {
    for (const float y : {30.f, 200.f, 370.f}) {
      const ImRect item({panel.Min.x + 10, y}, {panel.Max.x - 10, y + 20});
      const ImRect tip = of_item(panel, item);
      EXPECT_FALSE(tip.Overlaps(panel)) << panel.Min.x << ", " << y;
      EXPECT_TRUE(ImRect({0, 0}, {800, 600}).Contains(tip)) << panel.Min.x << ", " << y;
    }
  }
}

TEST_F(ATooltip, StandsAboveABarBelowAndBelowABarAbove) {
  for (const float top : {0.f, 560.f}) {
    const ImRect bar({0, top}, {800, top + 40});
    for (const float x : {20.f, 300.f, 700.f}) {
      const ImRect item({x, top + 10}, {x + 60, top + 30});
      const ImRect tip = of_item(bar, item);
      EXPECT_FALSE(tip.Overlaps(item)) << x << ", " << top;
      // The tooltip covers nothing else in the bar, such as the time beside the timeline.
      EXPECT_FALSE(tip.Overlaps(ImRect({0, top + 10}, {800, top + 30}))) << x << ", " << top;
      EXPECT_TRUE(ImRect({0, 0}, {800, 600}).Contains(tip)) << x << ", " << top;
    }
  }
}

// Words take the room beside the panel: 26 times the font's size at most.
TEST_F(ATooltip, IsAsWideAsALineOfWords) {
  const ImRect left({0, 20}, {250, 400}), right({560, 20}, {800, 400}), bar({0, 560}, {800, 600});
  for (const ImRect& panel : {left, right, bar}) {
    for (const float part : {0.1f, 0.9f}) {
      const float x = panel.Min.x + part * (panel.GetWidth() - 30);
      const ImRect tip = of_item(panel, ImRect({x, panel.Min.y + 5}, {x + 30, panel.Min.y + 25}));
      EXPECT_GT(tip.GetWidth(), 320) << panel.Min.x << ", " << part;
      EXPECT_LT(tip.GetWidth(), 26 * 13 + 20) << panel.Min.x << ", " << part;
    }
  }
}

}  // namespace
}  // namespace limpid
