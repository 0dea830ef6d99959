// Fields of a device's notes: each changes its own number, and says when the device is to be
// connected anew.
#include <cstdio>

#include "app/desktop/device/device_panel.h"
#include "core/dynamics/arm_description.h"
#include "tests/app/desktop/widgets/read_panel.h"

namespace limpid {
namespace {

using testing::HasSubstr;

class DeviceFields : public ReadPanel {
 protected:
  DeviceFields() {
    notes_.axes = {{.zero = 0.1, .scale = 2}, {}};
    notes_.checked = true;
    notes_.torque_scale = 1.5;
    joints_.resize(2);
    joints_[1].kind = Joint::Kind::prismatic;
  }
  void draw() {
    anew_ = limits_ = false;
    show([this] {
      const NotesEdited edited = draw_notes(notes_, angles_, joints_, uncalibrated_, fixed_);
      anew_ |= edited.anew;
      limits_ |= edited.limits;
    });
  }
  // Clicks on the n-th of several equal words, from above.
  void click_on(const std::string& text, std::size_t n) {
    std::vector<test::DrawnText> all;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.text == text) all.push_back(each);
    }
    ASSERT_GT(all.size(), n) << text << " in:\n" << words();
    click(all[n].middle());
  }

  DeviceNotes notes_;
  std::vector<Joint> joints_;
  std::vector<double> angles_{0.5, 0.25};
  bool uncalibrated_ = false, fixed_ = false;
  bool anew_ = false, limits_ = false;
};

TEST_F(DeviceFields, ShowAnglesInDegreesAndSlidesInMillimetres) {
  draw();
  EXPECT_THAT(words(), HasSubstr("axis 1")) << words();
  EXPECT_THAT(words(), HasSubstr("+28.65")) << "half a radian";
  const double millimetres = 1e3 * kSlideUnit * 0.25;
  char text[32];
  std::snprintf(text, sizeof text, "%+.1f mm", millimetres);
  EXPECT_THAT(words(), HasSubstr(text));
}

TEST_F(DeviceFields, TurnAnAxisRoundItsTorqueOrBoth) {
  draw();
  EXPECT_THAT(hint("invert"), HasSubstr("Reverses the sign of the axis and of its torque."));
  EXPECT_THAT(hint("reverse force"), HasSubstr("After a change here the axes are checked again"));
  click_on("invert", 1);
  EXPECT_TRUE(anew_);
  EXPECT_FALSE(notes_.axes[0].inverted);
  EXPECT_TRUE(notes_.axes[1].inverted);
  EXPECT_TRUE(notes_.checked) << "an axis that is turned whole stays stable";
  click_on("reverse force", 0);
  EXPECT_TRUE(notes_.axes[0].reversed);
  EXPECT_FALSE(notes_.checked);
}

TEST_F(DeviceFields, TakeThePresentPlaceForZero) {
  draw();
  EXPECT_EQ(hint("zero here"), "The present position becomes zero.");
  click_on("zero here", 0);
  EXPECT_TRUE(anew_);
  EXPECT_NEAR(notes_.axes[0].zero, 0.1 + 0.5 / notes_.axes[0].factor(), 1e-12);
  EXPECT_EQ(notes_.axes[1], AxisAdjustment{});
}

TEST_F(DeviceFields, OfACapAreItsDirectionsAlone) {
  joints_.clear();
  draw();
  EXPECT_THAT(words(), HasSubstr("+0.50"));
  EXPECT_FALSE(find("zero here"));
  EXPECT_FALSE(find("Limits of force"));
  click_on("invert", 0);
  EXPECT_TRUE(notes_.axes[0].inverted);
}

TEST_F(DeviceFields, OfAJoystickWithoutUnitsAreForceAndRange) {
  draw();
  EXPECT_FALSE(find("full force"));
  uncalibrated_ = true;
  draw();
  EXPECT_THAT(hint("full force"), HasSubstr("USB gives forces without a unit"));
  EXPECT_THAT(hint("range"), HasSubstr("Largest angle of the stick"));
}

TEST_F(DeviceFields, OfLimitsNameEachOfThem) {
  draw();
  EXPECT_FALSE(find(kSafetyLimits[0].caption));
  click("Limits of force");
  for (const auto& limit : kSafetyLimits) {  // long ones are cut in this font
    EXPECT_THAT(words(), HasSubstr(std::string(limit.caption).substr(0, 12)));
  }
  EXPECT_THAT(hint("Limits of force"), HasSubstr("You can lower these limits"));
}

}  // namespace
}  // namespace limpid
