// Devices that come and go beside the window: how one gets into the loop, and what is said of each
// step.
#include "devices/hid/hid_transport.h"
#include "tests/app/desktop/shell/a_desktop.h"

namespace limpid {
namespace {

std::shared_ptr<test::Wire>& controlled_wire() {
  static std::shared_ptr<test::Wire> wire;
  return wire;
}

struct ADeviceController : ADesktop {
  void SetUp() override {
    ADesktop::SetUp();
    controlled_wire() = std::make_shared<test::Wire>();
    found_.place = {"A paddle", "paddle", ""};
    found_.kind = &kPushes;
    found_.open = [](const FoundDevice&, const PidSettings&, const AskForPriority&,
                     DeviceClaim) -> std::unique_ptr<Device> {
      return std::make_unique<test::WiredDevice>(3, controlled_wire());
    };
    found_.claim_key = [](const FoundDevice&) { return std::string("a paddle of this test"); };
    if (desktop) devices().hub().notes("paddle").checked = true;
  }
  DeviceController& devices() const { return desktop->devices; }
  // Frames in which the device is plugged in; it is in no list of real devices.
  template <class Done>
  bool while_plugged_in(Done done) {
    return test::until([&] { return done(); },
                       [&] {
                         devices().hub().take({found_});
                         frames(1);
                       });
  }
  bool problem_is(const std::string& words) {
    return while_plugged_in([&] { return devices().problem() == words; });
  }

  static constexpr DeviceKind kPushes{
      .key = "test", .name = "Test", .pushes = true, .arm = "omni.urdf"};
  FoundDevice found_;
};

TEST_F(ADeviceController, SaysWhyItCannotConnect) {
  devices().use("paddle");
  ASSERT_TRUE(until([&] { return devices().problem() == "not connected"; }));
  found_.missing = "Nobody may open it.";
  EXPECT_TRUE(problem_is("Nobody may open it.")) << devices().problem();
  found_.missing.clear();
  found_.in_use_by = "another program";
  EXPECT_TRUE(problem_is("The device is in use by another program.")) << devices().problem();
  found_.in_use_by.clear();
  found_.open = [](const FoundDevice&, const PidSettings&, const AskForPriority&,
                   DeviceClaim) -> std::unique_ptr<Device> {
    throw HidError("the cable is broken");
  };
  EXPECT_TRUE(problem_is("the cable is broken")) << devices().problem();
  EXPECT_FALSE(loop().device_plugged());
}

TEST_F(ADeviceController, ConnectsToNothingWhoseAxesWereNotChecked) {
  devices().hub().notes("paddle").checked = false;
  devices().use("paddle");
  EXPECT_TRUE(problem_is("The device's axes must be checked before the device may give force."))
      << devices().problem();
  EXPECT_TRUE(devices().awaits_check());
  EXPECT_FALSE(loop().device_plugged());
  EXPECT_EQ(devices().check(), nullptr);
}

TEST_F(ADeviceController, WaitsForTheEndOfARecording) {
  devices().use("paddle");
  ASSERT_TRUE(until([&] { return devices().problem() == "not connected"; }));
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return loop().snapshot().recording; }));
  EXPECT_TRUE(problem_is("the device waits for the end of the recording")) << devices().problem();
  devices().use("another");
  EXPECT_TRUE(said("Stop the recording before you change the device."));
  EXPECT_EQ(devices().hub().in_use(), "paddle") << "it was not changed";
  devices().say_arm({});
  EXPECT_TRUE(said("Stop the recording before you choose the device's arm."));
  EXPECT_FALSE(loop().device_plugged());
  desktop->world.toggle_recording();
  EXPECT_TRUE(while_plugged_in([&] { return loop().device_in_place(); })) << devices().problem();
}

TEST_F(ADeviceController, LeavesTheChoiceToThePersonWhereThatIsAsked) {
  devices().wait_for_choice("Another window has it.");
  devices().hub().use("paddle");
  EXPECT_TRUE(problem_is("Another window has it.")) << devices().problem();
  EXPECT_TRUE(devices().waits_for_choice());
  found_.in_use_by = "a bench";
  EXPECT_TRUE(problem_is("Another window has it. The device is in use by a bench."))
      << devices().problem();
  found_.in_use_by.clear();
  devices().use("paddle");
  EXPECT_FALSE(devices().waits_for_choice());
  EXPECT_TRUE(while_plugged_in([&] { return loop().device_in_place(); })) << devices().problem();
}

}  // namespace
}  // namespace limpid
