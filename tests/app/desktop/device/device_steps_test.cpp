// The card of a device in the window: what each step says, asks and does.
#include "tests/app/desktop/shell/whole_window.h"
#include "tests/support/wired_device.h"

namespace limpid {
namespace {

using testing::HasSubstr;
using testing::Not;

class TheDevicesCard : public WholeWindow {
 protected:
  void SetUp() override {
    WholeWindow::SetUp();
    if (!desktop) return;
    height = 2000;
    desktop->settings.everything = true;
    frames(3);
    if (!find("Its axes", kSidePanel)) click("Device", kSidePanel);
    desktop->devices.hub().use("device");
    frames(3);
  }
  DeviceNotes& notes() { return desktop->devices.hub().notes("device"); }
  std::shared_ptr<test::Wire> plug_in() {
    auto wire = std::make_shared<test::Wire>();
    desktop->world.open_device(std::make_unique<test::WiredDevice>(3, wire));
    EXPECT_TRUE(until([&] { return desktop->live.loop().snapshot().connected; }));
    frames(5);
    return wire;
  }
  std::string says() const { return sentences(kSidePanel); }
};

TEST_F(TheDevicesCard, WaitsForTheDevice) {
  EXPECT_THAT(says(), HasSubstr("Found: not plugged in"));
  for (const char* later : {"Its arm", "Its axes", "Inertia, friction, delay", "Force"}) {
    EXPECT_TRUE(find(later, kSidePanel)) << later << " says nothing yet:\n" << words(kSidePanel);
  }
  for (const char* button :
       {"Identify...", "Identify again...", "Check the axes", "Another arm..."}) {
    EXPECT_FALSE(find(button, kSidePanel)) << button;
  }
}

TEST_F(TheDevicesCard, SaysWhatTheCheckOfItsAxesDoes) {
  static constexpr DeviceKind kPushes{.key = "test", .name = "Test", .pushes = true};
  FoundDevice found;
  found.place = {"A device", "device", ""};
  found.kind = &kPushes;
  const auto says_it = [&] {
    desktop->devices.hub().take({found});  // it is in no list of real devices
    frames(1);
    if (const auto button = find("Check the axes", kSidePanel)) show_mouse(button->middle());
    const std::string said = sentences("##Tooltip");
    return said.find("with a tenth of the force") != std::string::npos &&
           said.find("Let go of the device.") != std::string::npos;
  };
  EXPECT_TRUE(until(says_it)) << words(kSidePanel) << sentences("##Tooltip");
}

// The device never moves: its first axis is pushed, the first time, until the check gives up.
TEST_F(TheDevicesCard, DrawsWhichWayTheCheckOfItsAxesPushes) {
  static constexpr DeviceKind kOmni{
      .key = "test", .name = "Test", .pushes = true, .arm = "omni.urdf"};
  FoundDevice found;
  found.place = {"A device", "device", ""};
  found.kind = &kOmni;
  found.open = [](const FoundDevice&, const PidSettings&, const AskForPriority&,
                  DeviceClaim) -> std::unique_ptr<Device> {
    return std::make_unique<test::WiredDevice>(3, std::make_shared<test::Wire>());
  };
  found.claim_key = [](const FoundDevice&) { return std::string("a device of this test"); };
  const auto drawn = [&] {
    desktop->devices.hub().take({found});  // it is in no list of real devices
    if (desktop->devices.awaits_check()) desktop->devices.start_check();
    frames(1);
    return find("from above", kSidePanel) && find("y left", kSidePanel) &&
           says().find("First of two pushes") != std::string::npos;
  };
  EXPECT_TRUE(until(drawn)) << words(kSidePanel);
  EXPECT_THAT(says(), HasSubstr("checking axis 1"));
  desktop->devices.cancel_check();
  EXPECT_TRUE(until([&] { return desktop->devices.check() == nullptr; }));
}

TEST_F(TheDevicesCard, SaysWhatIsAssumedAndLeadsToTheIdentification) {
  plug_in();
  const std::string said = says();
  EXPECT_THAT(said, HasSubstr("Its axes: move as they are pushed"));
  EXPECT_THAT(said, HasSubstr("Inertia, friction, delay: assumed"));
  EXPECT_THAT(said, HasSubstr("not measured"));
  EXPECT_THAT(said, HasSubstr("Force: " + std::string(explain(ForceState::off))));
  EXPECT_THAT(said, Not(HasSubstr("of the commanded torque")));
  EXPECT_THAT(hint("Identify...", kSidePanel),
              HasSubstr("measures inertia, friction, weight and delay"));
  EXPECT_THAT(hint("not measured", kSidePanel) + hint("delay", kSidePanel),
              HasSubstr("Identify the device to measure the delay."));
  click("Identify...", kSidePanel);
  EXPECT_EQ(desktop->dialog.name(), "identify");
}

TEST_F(TheDevicesCard, SaysWhatWasMeasuredAndReckonsWithIt) {
  plug_in();
  notes().arm = "/somewhere/identified.urdf";
  notes().delay = 0.0021;
  notes().torque_scale = 1.25;
  desktop->settings.parameters().delay = 0;
  frames(3);
  const std::string said = says();
  EXPECT_THAT(said, HasSubstr("Inertia, friction, delay: measured"));
  EXPECT_THAT(said, HasSubstr("give 1.250 of the commanded torque"));
  EXPECT_THAT(said, HasSubstr("2.1 ms, measured"));
  EXPECT_TRUE(find("Identify again...", kSidePanel));
  click("Calculate with 2 ticks of delay", kSidePanel);
  EXPECT_EQ(desktop->settings.parameters().delay, 2);
  frames(3);
  EXPECT_THAT(says(), Not(HasSubstr("Calculate with"))) << "it does";
  notes().delay = 0.0009;
  frames(3);
  EXPECT_TRUE(find("Calculate with 1 tick of delay", kSidePanel));
}

TEST_F(TheDevicesCard, SaysWhyThereIsNoForce) {
  const auto wire = plug_in();
  EXPECT_THAT(hint("Its arm: omni", kSidePanel), HasSubstr("set the limits of the force"));
  EXPECT_TRUE(until([&] {
    if (!desktop->live.force_armed()) desktop->live.loop().arm();
    return desktop->live.loop().snapshot().arming == Arming::on;
  }));
  frames(5);
  EXPECT_THAT(says(), HasSubstr("Force: " + std::string(explain(ForceState::on))));
  desktop->cut_force();
  ASSERT_TRUE(until([&] { return desktop->live.loop().snapshot().arming == Arming::off; }));
  frames(5);
  EXPECT_THAT(says(), HasSubstr("Force: " + std::string(explain(ForceState::off))));
}

}  // namespace
}  // namespace limpid
