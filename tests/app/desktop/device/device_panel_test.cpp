#include "app/desktop/device/device_panel.h"

#include <gtest/gtest.h>

#include "app/desktop/widgets/widgets.h"
#include "devices/device.h"
#include "tests/app/desktop/widgets/read_panel.h"

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

// Notes of a device with two turning axes and one that slides.
class NotesOfADevice : public ReadPanel {
 protected:
  NotesOfADevice() {
    joints_[2].kind = Joint::Kind::prismatic;
    notes_.checked = true;
  }
  void draw() {
    show([&] {
      const NotesEdited now = draw_notes(notes_, angles_, joints_, uncalibrated_, fixed_);
      edited_.anew = edited_.anew || now.anew;
      edited_.limits = edited_.limits || now.limits;
    });
  }
  // Clicks a text among those of an axis.
  void click_in_row(const std::string& axis, const std::string& text) {
    std::optional<ImVec2> at;
    bool in_row = false;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.text.starts_with("axis ")) in_row = each.text.starts_with(axis);
      if (each.text == text && in_row && !at) at = each.middle();
    }
    ASSERT_TRUE(at) << text << " of " << axis << " is not in:\n" << words();
    click(*at);
  }

  DeviceNotes notes_;
  std::vector<Joint> joints_ = std::vector<Joint>(3);
  std::vector<double> angles_{0.1, -0.2, 0.03 / kSlideUnit};
  bool uncalibrated_ = false, fixed_ = false;
  NotesEdited edited_;
};

TEST_F(NotesOfADevice, ShowWhereEachAxisIs) {
  draw();
  for (const char* row :
       {"axis 1[ \n]+.5.73\xC2\xB0\n", "axis 2[ \n]+-11.46\xC2\xB0\n", "axis 3[ \n]+.30.0 mm\n"}) {
    EXPECT_THAT(words(), testing::ContainsRegex(row));
  }
  joints_.clear();
  draw();
  EXPECT_TRUE(find("axis 2  -0.20")) << "of a cap's deflection:\n" << words();
  for (const char* text : {"reverse force", "zero here", "Limits of force"}) {
    EXPECT_FALSE(find(text)) << text;
  }
  EXPECT_FALSE(edited_.anew || edited_.limits);
}

TEST_F(NotesOfADevice, KeepTheDirectionOfTheAxisThatIsInverted) {
  draw();
  click_in_row("axis 2", "invert");
  ASSERT_EQ(notes_.axes.size(), 3u);
  EXPECT_TRUE(notes_.axes[1].inverted);
  EXPECT_FALSE(notes_.axes[0].inverted || notes_.axes[2].inverted || notes_.axes[1].reversed);
  EXPECT_TRUE(edited_.anew);
  EXPECT_TRUE(notes_.checked);
}

// With the wrong sign the loop is unstable.
TEST_F(NotesOfADevice, AskForACheckOfAnAxisWhoseForceIsReversed) {
  draw();
  click_in_row("axis 1", "reverse force");
  EXPECT_TRUE(notes_.axes.at(0).reversed);
  EXPECT_TRUE(edited_.anew);
  EXPECT_FALSE(notes_.checked);
}

// The angle is that after direction and scale; the zero is before them.
TEST_F(NotesOfADevice, TakeThePresentPlaceForZero) {
  notes_.axes = {{}, {.zero = 0.05, .scale = 2, .inverted = true}};
  draw();
  click_in_row("axis 2", "zero here");
  EXPECT_NEAR(notes_.axes[1].zero, 0.05 + 0.1, 1e-12);
  EXPECT_EQ(notes_.axes[0].zero, 0);
  EXPECT_TRUE(edited_.anew);
}

TEST_F(NotesOfADevice, HaveSettingsOfAJoystickForThoseWithoutCalibration) {
  draw();
  for (const auto& field : kPidFields) EXPECT_FALSE(find(field.caption)) << field.caption;
  uncalibrated_ = true;
  draw();
  for (const auto& field : kPidFields) EXPECT_TRUE(find(field.caption)) << field.caption;
}

TEST_F(NotesOfADevice, UnfoldTheLimitsOfForce) {
  draw();
  click("Limits of force");
  EXPECT_NE(hint("Limits of force"), "");
  for (const auto& limit : kSafetyLimits) {  // the end of a long caption is cut off
    EXPECT_THAT(words(), testing::HasSubstr(std::string(limit.caption).substr(0, 12)));
  }
  EXPECT_FALSE(edited_.limits);
}

}  // namespace
}  // namespace limpid
