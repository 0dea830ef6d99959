#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "devices/hid/device_list.h"
#include "devices/hid/hid_transport.h"
#include "tests/support/fake_hid.h"
#include "tests/support/hid_descriptors.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::Bytes;

// A system with a sysfs and a /dev of its own.
struct FakeSystem : testing::Test {
  void plug_in(const std::string& node, const Bytes& descriptor, const std::string& uevent) {
    const fs::path device = roots.sysfs / node / "device";
    fs::create_directories(device);
    fs::create_directories(roots.dev);
    std::ofstream(device / "report_descriptor", std::ios::binary)
        .write(reinterpret_cast<const char*>(descriptor.data()),
               static_cast<std::streamsize>(descriptor.size()));
    std::ofstream(device / "uevent") << uevent;
    std::ofstream(roots.dev / node).put('\n');
  }
  std::vector<FoundDevice> list() const { return list_hid_devices("rules", roots); }

  test::TempDir dir;
  HidRoots roots{dir / "sys", dir / "dev"};
};

TEST_F(FakeSystem, FindsTheThreeKindsOfDevices) {
  plug_in("hidraw2", test::raw_device(),
          "DRIVER=hid-generic\nHID_ID=0003:00001209:00004C50\nHID_NAME=Limpid T2\nHID_UNIQ=007\n");
  plug_in("hidraw0", test::space_navigator(),
          "HID_ID=0003:0000046D:0000C626\nHID_NAME=3Dconnexion SpaceNavigator\nHID_UNIQ=\n");
  plug_in("hidraw1", test::pid_joystick::whole(),
          "HID_ID=0003:0000045E:0000001B\nHID_NAME=SideWinder Force Feedback 2\n");
  const auto found = list();
  ASSERT_EQ(found.size(), 3u);
  EXPECT_STREQ(found[0].kind->key, "space_mouse");
  EXPECT_EQ(found[0].place.id, "046d:c626");
  EXPECT_EQ(found[0].place.name, "3Dconnexion SpaceNavigator");
  EXPECT_STREQ(found[1].kind->key, "pid");
  EXPECT_STREQ(found[2].kind->key, "raw");
  EXPECT_EQ(found[2].place.id, "1209:4c50:007");
  EXPECT_EQ(found[2].place.path, (roots.dev / "hidraw2").string());
  EXPECT_EQ(found[2].missing, "");
}

TEST_F(FakeSystem, LeavesOutWhatIsNoHapticDevice) {
  const Bytes mouse{0x05, 0x01, 0x09, 0x02, 0xA1, 0x01, 0x09, 0x30, 0x15, 0x81,
                    0x25, 0x7F, 0x75, 0x08, 0x95, 0x01, 0x81, 0x06, 0xC0};
  plug_in("hidraw0", mouse, "HID_ID=0003:0000046D:0000C077\n");
  plug_in("hidraw1", {0xC0, 0xC0}, "");
  fs::create_directories(roots.sysfs / "hidraw2");
  EXPECT_TRUE(list().empty());
}

TEST_F(FakeSystem, IsEmptyWithoutHidraw) { EXPECT_TRUE(list().empty()); }

// A game pad speaks PID, but cannot be an arm.
TEST_F(FakeSystem, SaysThatAGamePadIsNoArm) {
  Bytes pad = test::pid_joystick::whole();
  pad[3] = 0x05;  // the usage of its outermost collection
  plug_in("hidraw0", pad, "HID_NAME=GC adapter\n");
  plug_in("hidraw1", test::pid_joystick::whole(), "HID_NAME=Stick\n");
  const auto found = list();
  ASSERT_EQ(found.size(), 2u);
  EXPECT_THAT(found[0].missing, testing::HasSubstr("game pad"));
  EXPECT_EQ(found[1].missing, "");
}

TEST_F(FakeSystem, SaysHowToGetPermission) {
  plug_in("hidraw0", test::raw_device(), "HID_NAME=T2\n");
  fs::permissions(roots.dev / "hidraw0", fs::perms::none);
  if (geteuid() == 0) GTEST_SKIP() << "the superuser may do anything";
  ASSERT_EQ(list().size(), 1u);
  EXPECT_THAT(list()[0].missing, testing::HasSubstr("sudo cp rules /etc/udev/rules.d/"));
}

TEST_F(FakeSystem, SaysWhenTheNodeIsNotThere) {
  plug_in("hidraw0", test::raw_device(), "HID_NAME=T2\n");
  fs::remove(roots.dev / "hidraw0");
  ASSERT_EQ(list().size(), 1u);
  EXPECT_THAT(list()[0].missing, testing::HasSubstr("does not exist"));
}

TEST_F(FakeSystem, DoesNotConnectToWhatIsNoHidDevice) {
  plug_in("hidraw0", test::raw_device(), "HID_NAME=T2\n");
  try {
    open_device(list().at(0));
    FAIL();
  } catch (const HidError& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("T2: " + (roots.dev / "hidraw0").string()));
  }
}

// Another device may have appeared at the same path since the list was made.
TEST_F(FakeSystem, OpensNothingButTheKindThatItFound) {
  plug_in("hidraw0", test::space_navigator(), "HID_NAME=SpaceNavigator\n");
  plug_in("hidraw1", test::pid_joystick::whole(), "HID_NAME=Stick\n");
  const auto found = list();
  ASSERT_EQ(found.size(), 2u);
  const auto opened = [](const FoundDevice& device, const Bytes& descriptor) {
    std::string asked;
    const auto there = std::make_shared<test::FakeHid>();
    there->descriptor = descriptor;
    const auto open = [&](const std::string& path) {
      asked = path;
      return std::make_unique<test::FakeTransport>(there);
    };
    try {
      open_hid_device_on(device, open, {}, {}, {});
    } catch (const HidError& error) {
      EXPECT_EQ(asked, device.place.path);
      EXPECT_TRUE(there->received().empty()) << "no report to a stranger";
      EXPECT_TRUE(there->features_set.empty());
      return std::string(error.what());
    }
    return std::string("opened");
  };
  EXPECT_EQ(opened(found[0], test::space_navigator()), "opened");
  EXPECT_EQ(opened(found[0], test::pid_joystick::whole()),
            "SpaceNavigator: the device has been unplugged");
  EXPECT_EQ(opened(found[1], test::space_navigator()), "Stick: the device has been unplugged");
  const Bytes mouse{0x05, 0x01, 0x09, 0x02, 0xA1, 0x01, 0x09, 0x30, 0x15, 0x81,
                    0x25, 0x7F, 0x75, 0x08, 0x95, 0x01, 0x81, 0x06, 0xC0};
  EXPECT_EQ(opened(found[1], mouse), "Stick: the device has been unplugged");
}

// Holds for devices of the same kind, too: stored settings belong to the other one.
TEST_F(FakeSystem, OpensNothingButTheDeviceThatItFound) {
  plug_in("hidraw0", test::space_navigator(), "HID_ID=0003:0000046D:0000C626\nHID_UNIQ=A7\n");
  const auto found = list();
  ASSERT_EQ(found.size(), 1u);
  const auto there = std::make_shared<test::FakeHid>();
  there->descriptor = test::space_navigator();
  const auto open = [&](const std::string&) {
    return std::make_unique<test::FakeTransport>(there);
  };
  for (const char* other : {"046d:c626", "046d:c626:A8", "046d:c627:A7"}) {
    there->id = other;
    EXPECT_THROW(open_hid_device_on(found[0], open, {}, {}, {}), HidError) << other;
  }
  there->id = found[0].place.id;
  EXPECT_NO_THROW(open_hid_device_on(found[0], open, {}, {}, {}));
}

TEST_F(FakeSystem, UsesNoDeviceThatPushesWhoseIdAnotherHasToo) {
  for (const char* node : {"hidraw0", "hidraw1"}) {
    plug_in(node, test::raw_device(), "HID_ID=0003:00001209:00004C50\n");
  }
  plug_in("hidraw2", test::raw_device(), "HID_ID=0003:00001209:00004C50\nHID_UNIQ=7\n");
  for (const char* node : {"hidraw3", "hidraw4"}) {
    plug_in(node, test::space_navigator(), "HID_ID=0003:0000046D:0000C626\n");
  }
  auto found = list();
  ASSERT_EQ(found.size(), 5u);
  refuse_doubles(found);
  for (const std::size_t i : {0u, 1u}) {
    EXPECT_EQ(found[i].missing, "2 devices have the id 1209:4c50: unplug all but one");
  }
  for (const std::size_t i : {2u, 3u, 4u}) EXPECT_EQ(found[i].missing, "") << i;
}

}  // namespace
}  // namespace limpid
