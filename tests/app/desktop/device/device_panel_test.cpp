#include "app/desktop/device/device_panel.h"

#include <gtest/gtest.h>

#include "app/desktop/widgets/widgets.h"
#include "tests/app/plot/imgui_frames.h"

namespace limpid {
namespace {

TEST(DevicePanel, HandsNoLawMoreDelayThanItCanReckonWith) {
  Parameters p;
  EXPECT_EQ(reckoning_with(p, 0.0021).delay, 2);
  EXPECT_EQ(reckoning_with(p, 0.0004).delay, 0);
  p.tick = 1e-4;
  EXPECT_EQ(reckoning_with(p, 0.0015).delay, 15);
  EXPECT_EQ(reckoning_with(p, 0.012).delay, 20) << "120 ticks have no room in its ring";
}

// Numbers of a file that no float holds exactly: values that are only shown must come back
// unchanged.
TEST_F(ImGuiFrames, TheDevicePanelChangesNothingThatItOnlyShows) {
  DeviceNotes notes;
  notes.axes = {{.zero = 0.1, .scale = 0.3}};
  notes.pid.effort = 0.8;
  notes.pid.range = 0.35;
  notes.torque_scale = 1.8;
  notes.limits.tip_force = 2.1;
  notes.checked = true;
  const DeviceNotes before = notes;
  const std::vector<Joint> joints(2);
  const std::vector<double> angles{0.01, -0.2};
  for (const bool cap : {false, true}) {
    for (int i = 0; i < 3; ++i) {
      frame([&] {
        ImGui::GetStateStorage()->SetInt(ImGui::GetID("Limits of force"), 1);
        const NotesEdited edited =
            draw_notes(notes, angles, cap ? std::span<const Joint>() : joints, true, false);
        EXPECT_FALSE(edited.anew || edited.limits);
      });
    }
  }
  EXPECT_EQ(notes.axes, before.axes) << "nor has an axis more been noted";
  EXPECT_EQ(notes.pid.effort, 0.8);
  EXPECT_EQ(notes.pid.range, 0.35);
  EXPECT_EQ(notes.torque_scale, 1.8);
  EXPECT_EQ(notes.limits, before.limits);
  EXPECT_TRUE(notes.checked);
}

}  // namespace
}  // namespace limpid
