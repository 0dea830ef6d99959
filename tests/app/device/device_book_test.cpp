#include "app/device/device_book.h"

#include <gtest/gtest.h>

#include <fstream>

#include "app/device/device_hub.h"
#include "app/device/urdf_writer.h"
#include "devices/files/arm/urdf_file.h"
#include "devices/files/file_error.h"
#include "tests/support/device_traits.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

DeviceBook written_and_read(const DeviceBook& book, const std::filesystem::path& file) {
  EXPECT_EQ(save_device_book(book, file), "");
  std::string complaint;
  DeviceBook read = load_device_book(file, complaint);
  EXPECT_EQ(complaint, "");
  return read;
}

TEST(DeviceBook, RemembersTheDeviceInUseAndItsAxes) {
  const test::TempDir dir;
  DeviceBook book;
  book.in_use = "1209:4c50:a \"serial\" number";
  DeviceNotes& notes = book.notes[book.in_use];
  notes.axes = {{0.25, 1, true}, {-1.5, 0.4, false}};
  notes.pid.effort = 1.75;
  notes.pid.range = 0.6;
  notes.pid.reverse = {false, true};
  const DeviceBook read = written_and_read(book, dir / "below/devices.toml");
  EXPECT_EQ(read.in_use, book.in_use);
  ASSERT_EQ(read.notes.count(book.in_use), 1U);
  const DeviceNotes& again = read.notes.at(book.in_use);
  ASSERT_EQ(again.axes.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again.axes[i].zero, notes.axes[i].zero);
    EXPECT_EQ(again.axes[i].scale, notes.axes[i].scale);
    EXPECT_EQ(again.axes[i].inverted, notes.axes[i].inverted);
  }
  EXPECT_EQ(again.pid.effort, 1.75);
  EXPECT_EQ(again.pid.range, 0.6);
  EXPECT_EQ(again.pid.reverse, notes.pid.reverse);
}

TEST(DeviceBook, LowersLimitsAndNeverRaisesThem) {
  const test::TempDir dir;
  DeviceBook book;
  book.notes["id"].limits = {.tip_speed = 0.5, .tip_force = 3, .range = 0.8};
  const SafetyLimits read = written_and_read(book, dir / "devices.toml").notes["id"].limits;
  EXPECT_EQ(read.tip_speed, 0.5);
  EXPECT_EQ(read.tip_force, 3);
  EXPECT_EQ(read.range, 0.8);
  EXPECT_EQ(read.joint_speed, 15);
  std::ofstream(dir / "by_hand.toml") << R"(
[device.id.limits]
joint_speed = 100
tip_speed = nan
tip_force = -1
energy = "much"
range = 2
)";
  std::string complaint;
  const SafetyLimits most = load_device_book(dir / "by_hand.toml", complaint).notes["id"].limits;
  EXPECT_EQ(most.joint_speed, 15);
  EXPECT_EQ(most.tip_speed, 2);
  EXPECT_EQ(most.tip_force, 10);
  EXPECT_EQ(most.energy, 1.5);
  EXPECT_EQ(most.range, 1);
}

// Joints that give way by so much a newton metre.
AxisCheck checked(const std::vector<double>& give) {
  AxisCheck check(test::pushing(static_cast<int>(give.size()), 0.35));
  std::vector<double> x(give.size());
  for (int i = 0; i < 20'000 && !check.done(); ++i) {
    const auto torque = check.step({x, 1e-3, true});
    for (std::size_t j = 0; j < give.size(); ++j) x[j] = give[j] * torque[j];
  }
  return check;
}

TEST(DeviceBook, RemembersWhatACheckHasFound) {
  const test::TempDir dir;
  DeviceBook book;
  DeviceNotes& notes = book.notes["a"];
  notes.pid.reverse = {false, true};
  EXPECT_FALSE(notes.checked);
  EXPECT_TRUE(remember_check(checked({0.5, -0.5}), notes));
  EXPECT_TRUE(notes.checked);
  EXPECT_EQ(notes.pid.reverse, (std::array{false, false})) << "reversed once more";
  EXPECT_TRUE(remember_check(checked({-0.5, 0.5}), notes));
  EXPECT_EQ(notes.pid.reverse, (std::array{true, false}));
  const DeviceNotes again = written_and_read(book, dir / "devices.toml").notes.at("a");
  EXPECT_TRUE(again.checked);
  EXPECT_EQ(again.pid.reverse, (std::array{true, false}));
}

TEST(DeviceBook, RemembersNothingOfACheckThatFailed) {
  DeviceNotes notes;
  notes.pid.reverse = {true, false};
  EXPECT_FALSE(remember_check(checked({-0.5, 0}), notes));
  EXPECT_FALSE(notes.checked);
  EXPECT_EQ(notes.pid.reverse, (std::array{true, false}));
}

// Written before there were checks.
TEST(DeviceBook, TakesTheJoysticksOfOldBooksForUnchecked) {
  const test::TempDir dir;
  const auto file = dir / "devices.toml";
  std::ofstream(file) << "in_use = \"a\"\n[device.a]\nrange = 0.6\neffort = 1.75\n"
                         "reverse = [true, false]\naxis = [{zero = 0.25, scale = 1.0, inverted = "
                         "true}]\n";
  std::string complaint;
  const DeviceNotes notes = load_device_book(file, complaint).notes.at("a");
  EXPECT_EQ(complaint, "");
  EXPECT_FALSE(notes.checked);
  EXPECT_EQ(notes.pid.reverse, (std::array{true, false}));
  EXPECT_EQ(notes.pid.range, 0.6);
  EXPECT_EQ(notes.pid.effort, 1.75);
  EXPECT_TRUE(notes.axes.at(0).inverted);
}

TEST(DeviceBook, LeavesOutWhatMakesNoSense) {
  const test::TempDir dir;
  const auto file = dir / "devices.toml";
  std::ofstream(file) << "in_use = \"a\"\n[device.a]\neffort = -3.0\nrange = nan\n"
                         "axis = [{scale = 0.0, zero = 1.0}, 7]\n";
  std::string complaint;
  const DeviceBook book = load_device_book(file, complaint);
  EXPECT_EQ(complaint, "");
  const DeviceNotes& notes = book.notes.at("a");
  EXPECT_EQ(notes.pid.effort, PidSettings{}.effort);
  EXPECT_EQ(notes.pid.range, PidSettings{}.range);
  ASSERT_EQ(notes.axes.size(), 2U);
  EXPECT_EQ(notes.axes[0].scale, 1);
  EXPECT_EQ(notes.axes[0].zero, 1);
}

TEST(DeviceBook, SaysWhyAFileIsNotRead) {
  const test::TempDir dir;
  const auto file = dir / "devices.toml";
  std::ofstream(file) << "in_use = \n";
  std::string complaint;
  EXPECT_TRUE(load_device_book(file, complaint).notes.empty());
  EXPECT_NE(complaint.find(file.string()), std::string::npos);
}

TEST(DeviceHub, WantsAJoystickCheckedBeforeItPushes) {
  const test::TempDir dir;
  DeviceHub hub(dir / "devices.toml", {});
  const DeviceKind unknown{.uncalibrated = true}, known{};
  FoundDevice joystick, mouse;
  joystick.place.id = "joystick";
  joystick.kind = &unknown;
  mouse.place.id = "mouse";
  mouse.kind = &known;
  hub.take({joystick, mouse});
  EXPECT_FALSE(hub.needs_check()) << "none is in use";
  hub.use("mouse");
  EXPECT_FALSE(hub.needs_check());
  hub.use("joystick");
  EXPECT_TRUE(hub.needs_check());
  hub.notes("joystick").checked = true;
  EXPECT_FALSE(hub.needs_check());
}

DeviceTraits joints(int count, double effort) {
  DeviceTraits traits;
  traits.name = "a device";
  traits.dof = count;
  traits.effort.assign(static_cast<std::size_t>(count), effort);
  return traits;
}

TEST(ArmForADevice, HasAsManyJointsAndPushesNoHarder) {
  const ArmDescription omni = read_urdf(std::string(LIMPID_ASSETS_DIR) + "/devices/omni.urdf");
  const test::TempDir dir;
  const DeviceHub hub(dir / "devices.toml", {});
  const ArmDescription same = hub.arm_for(joints(3, 0.01), omni);
  EXPECT_EQ(same.urdf, omni.urdf);
  for (const Joint& joint : same.joints) EXPECT_EQ(joint.effort, 0.01);
  const ArmDescription strong = hub.arm_for(joints(3, 100), omni);
  EXPECT_EQ(strong.joints[1].effort, omni.joints[1].effort);
  EXPECT_EQ(hub.arm_for(joints(2, 0.2), omni).dof(), 2);
  EXPECT_EQ(hub.arm_for(joints(1, 0.2), omni).dof(), 1);
  EXPECT_THROW(hub.arm_for(joints(5, 1), omni), FileError);
}

TEST(ArmForADevice, IsWhatItWasIdentifiedAsUntilThatIsForgotten) {
  const test::TempDir dir;
  setenv("XDG_DATA_HOME", (dir / "data").c_str(), 1);
  const ArmDescription omni = read_urdf(std::string(LIMPID_ASSETS_DIR) + "/devices/omni.urdf");
  ArmDescription found = omni;
  found.links[1].mass = 0.123;
  const CompensationSettings taken_off{
      .holds_weight = true, .down = Down::plus_x, .friction_share = 0.6, .holds_springs = true};
  {
    DeviceHub hub(dir / "devices.toml", {});
    hub.use("1209:4c50:a/b c");
    EXPECT_EQ(hub.remember({.urdf = urdf_text(found, "found"), .report = "{}", .delay = 0.0021}),
              "");
    hub.notes(hub.in_use()).compensation = taken_off;
    EXPECT_EQ(hub.save(), "");
  }
  DeviceHub hub(dir / "devices.toml", {});
  EXPECT_EQ(hub.arm_for(joints(3, 0.3), omni).links[1].mass, 0.123);
  EXPECT_EQ(hub.arm_for(joints(3, 0.3), omni).delay, 0.0021)
      << "its file lacks it, the book does not";
  EXPECT_EQ(hub.notes("1209:4c50:a/b c").compensation, taken_off);
  EXPECT_EQ(hub.notes("1209:4c50:a/b c").delay, 0.0021);
  std::filesystem::remove_all(dir / "data");
  try {
    hub.arm_for(joints(3, 0.3), omni);
    ADD_FAILURE() << "an arm that nobody has measured in its place";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("--forget"), std::string::npos) << error.what();
  }
  hub.forget_arm();
  EXPECT_LT(hub.notes("1209:4c50:a/b c").delay, 0);
  EXPECT_EQ(hub.notes("1209:4c50:a/b c").compensation, CompensationSettings{});
  EXPECT_EQ(hub.arm_for(joints(3, 0.3), omni).links[1].mass, omni.links[1].mass);
}

TEST(DeviceBook, TakesNoCompensationThatIsOutOfRange) {
  const test::TempDir dir;
  std::ofstream(dir / "devices.toml")
      << "[device.a.compensation]\nfriction = 1.5\ndown = 'up'\ngravity = true\nsprings = 3\n";
  std::string complaint;
  const DeviceBook book = load_device_book(dir / "devices.toml", complaint);
  EXPECT_EQ(book.notes.at("a").compensation, CompensationSettings{.holds_weight = true});
}

// What is found the second time was found with the first correction in place.
TEST(DeviceHub, CorrectsATorqueScaleByWhatIsFoundAgain) {
  const test::TempDir dir;
  setenv("XDG_DATA_HOME", (dir / "data").c_str(), 1);
  DeviceHub hub(dir / "devices.toml", {});
  hub.use("a device");
  const DeviceHub::Nature half{.urdf = "<robot/>", .report = "{}", .delay = 0, .torque_scale = 0.5};
  EXPECT_EQ(hub.remember(half), "");
  EXPECT_EQ(hub.notes("a device").torque_scale, 0.5);
  EXPECT_EQ(hub.remember(half), "");
  EXPECT_EQ(hub.notes("a device").torque_scale, 0.25);
  EXPECT_EQ(hub.remember(half), "");
  EXPECT_NE(hub.remember(half), "") << "0.0625 is not believed";
  EXPECT_EQ(hub.notes("a device").torque_scale, 0.125) << "and changes nothing";
}

}  // namespace
}  // namespace limpid
