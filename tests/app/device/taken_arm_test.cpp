// The arm that a device is taken for; its limits are never wider than the device's.
#include "app/device/taken_arm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "app/run/urdf_writer.h"
#include "devices/files/urdf_file.h"
#include "tests/support/device_traits.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::HasSubstr;

const DeviceKind kRaw{.key = "raw"};
const DeviceKind kInverse{.key = "inverse3", .arm = "inverse3.urdf"};

ArmDescription shipped(const char* file) {
  return read_urdf(std::string(LIMPID_ASSETS_DIR) + "/devices/" + file);
}

// URDF of a stranger's arm: continuous joints, links of a metre, strong motors.
std::string long_arm(int joints) {
  std::string text = "<robot name=\"long\"><link name=\"l0\"/>";
  for (int i = 1; i <= joints; ++i) {
    text += fmt::format(
        "<joint name=\"j{0}\" type=\"continuous\"><parent link=\"l{1}\"/><child link=\"l{0}\"/>"
        "<axis xyz=\"0 {2} {3}\"/><origin xyz=\"1 0 0\"/>"
        "<limit effort=\"50\" velocity=\"10\"/></joint><link name=\"l{0}\"><inertial>"
        "<mass value=\"0.1\"/><inertia ixx=\"1e-3\" iyy=\"1e-3\" izz=\"1e-3\" ixy=\"0\" ixz=\"0\" "
        "iyz=\"0\"/></inertial></link>",
        i, i - 1, i % 2, 1 - i % 2);
  }
  return text + "</robot>";
}

struct ATakenArm : testing::Test {
  std::string write(const char* name, const std::string& text) const {
    std::ofstream(dir / name) << text;
    return (dir / name).string();
  }
  // Expects limits of a device with 3 N m and 0.35 rad to either side.
  static void expect_within_the_device(const ArmDescription& arm) {
    for (const Joint& joint : arm.joints) {
      EXPECT_LE(joint.effort, 3);
      EXPECT_GE(joint.lower, -0.35);
      EXPECT_LE(joint.upper, 0.35);
    }
  }

  test::TempDir dir;
  const DeviceTraits traits = test::pushing(3, 0.35, 3);
};

TEST_F(ATakenArm, HasJointsOfTheKindsThatTheDeviceHas) {
  DeviceTraits sliding = traits;
  sliding.slides = {true, true, true};
  EXPECT_THROW(narrowed(shipped("omni.urdf"), sliding), FileError);
  EXPECT_NO_THROW(narrowed(shipped("inverse3.urdf"), sliding));
  try {
    taken_arm({}, &kRaw, sliding);
    FAIL();
  } catch (const UnknownArmError& error) {
    EXPECT_THAT(error.what(), HasSubstr("joints that slide"));
  }
  DeviceTraits turning = traits;
  turning.slides = {false, false, false};
  EXPECT_NO_THROW(narrowed(shipped("omni.urdf"), turning));
  EXPECT_THROW(narrowed(shipped("inverse3.urdf"), turning), FileError);
}

// The device's levers may be short: at 5 cm, 10 N are 0.5 N m.
TEST_F(ATakenArm, IsABuiltInOneWithLittleForceUntilSomebodyHasSaidWhichItIs) {
  DeviceNotes notes;
  const TakenArm taken = taken_arm(notes, &kRaw, traits);
  EXPECT_FALSE(taken.known);
  EXPECT_EQ(taken.arm.urdf, shipped("omni.urdf").urdf);
  expect_within_the_device(taken.arm);
  for (const Joint& joint : taken.arm.joints) EXPECT_LE(joint.effort, 0.5);
  EXPECT_THAT(taken.why, HasSubstr("until you choose"));
  notes.limits.tip_force = 2;
  for (const Joint& joint : taken_arm(notes, &kRaw, traits).arm.joints) {
    EXPECT_LE(joint.effort, 0.1);
  }
}

TEST_F(ATakenArm, GivesNoForceToADeviceOfWhichNothingIsKnownAndNoBuiltInArmHasAsManyJoints) {
  DeviceNotes notes;
  EXPECT_THROW(taken_arm(notes, &kRaw, test::pushing(5, 3)), UnknownArmError);
  notes.taken_for = kBuiltInArm;
  EXPECT_THROW(taken_arm(notes, &kRaw, test::pushing(5, 3)), UnknownArmError);
  notes.taken_for = write("five.urdf", long_arm(5));
  const TakenArm taken = taken_arm(notes, &kRaw, test::pushing(5, 3));
  EXPECT_TRUE(taken.known);
  EXPECT_EQ(taken.arm.dof(), 5);
}

TEST_F(ATakenArm, IsWhatSomebodyHasSaidWithinTheRangesAndTorquesOfTheDeviceItself) {
  DeviceNotes notes;
  notes.taken_for = write("long.urdf", long_arm(3));
  const TakenArm taken = taken_arm(notes, &kRaw, traits);
  EXPECT_TRUE(taken.known);
  EXPECT_EQ(taken.arm.name, "long");
  EXPECT_THAT(taken.why, HasSubstr("the arm long"));
  expect_within_the_device(taken.arm);
  notes.taken_for = kBuiltInArm;
  const TakenArm built_in = taken_arm(notes, &kRaw, traits);
  EXPECT_TRUE(built_in.known);
  EXPECT_EQ(built_in.arm.joints[0].effort, shipped("omni.urdf").joints[0].effort);
}

TEST_F(ATakenArm, HoldsAnArmThatACommandNamesToTheDeviceAsWell) {
  const ArmDescription named = read_urdf(write("long.urdf", long_arm(3)));
  const TakenArm taken = taken_arm({}, &kRaw, traits, &named);
  EXPECT_EQ(taken.arm.name, "long");
  expect_within_the_device(taken.arm);
  const ArmDescription four = read_urdf(write("four.urdf", long_arm(4)));
  const TakenArm other = taken_arm({}, &kRaw, traits, &four);
  EXPECT_EQ(other.arm.name, "omni");
  EXPECT_THAT(other.why, HasSubstr("long of 4 joints. The device has 3 joints now"));
}

TEST_F(ATakenArm, IsAskedAnewWhereAnotherDeviceAnswersUnderTheId) {
  DeviceNotes notes;
  notes.taken_for = write("long.urdf", long_arm(3));
  notes.taken_as = what_it_is(traits.name, 3);
  EXPECT_TRUE(taken_arm(notes, &kRaw, traits).known);
  DeviceTraits another = traits;
  another.name = "another";
  const TakenArm taken = taken_arm(notes, &kRaw, another);
  EXPECT_FALSE(taken.known);
  EXPECT_EQ(taken.arm.name, "omni");
  EXPECT_THAT(taken.why, HasSubstr("another device: " + notes.taken_as));
}

TEST_F(ATakenArm, SaysThatADeviceHasOtherJointsNowThanItWasIdentifiedWith) {
  DeviceNotes notes;
  notes.arm = write("identified.urdf", urdf_text(shipped("joystick.urdf"), "joystick"));
  const TakenArm taken = taken_arm(notes, &kRaw, traits);
  EXPECT_FALSE(taken.known);
  EXPECT_EQ(taken.arm.dof(), 3);
  EXPECT_THAT(taken.why, HasSubstr("was identified as the arm"));
  EXPECT_THAT(taken.why, HasSubstr("of 2 joints. The device has 3 joints now"));
  try {
    taken_arm(notes, &kRaw, test::pushing(5, 3));
    ADD_FAILURE() << "no built-in arm has five joints";
  } catch (const UnknownArmError& error) {
    EXPECT_THAT(error.what(), HasSubstr("of 2 joints. The device has 5 joints now"));
    EXPECT_THAT(error.what(), HasSubstr("identify --forget"));
    EXPECT_THAT(error.what(), HasSubstr("--arm"));
  }
}

// The service knows its own levers and ranges: three slides in other places are a different arm.
TEST_F(ATakenArm, OfADeviceThatSaysItselfWhichItIsIsThatOne) {
  DeviceTraits cursor = test::pushing(3, 4, 0.4);
  const ArmDescription own = shipped("inverse3.urdf");
  EXPECT_EQ(taken_arm({}, &kInverse, cursor).arm.urdf, own.urdf);
  DeviceNotes notes;
  ArmDescription measured = own;
  measured.links[2].mass = 0.2;
  notes.arm = write("identified.urdf", urdf_text(measured, "measured"));
  EXPECT_EQ(taken_arm(notes, &kInverse, cursor).arm.links[2].mass, 0.2);
  ArmDescription strange = own;
  strange.joints[1].origin.translation().x() += 0.5;
  notes.arm = write("strange.urdf", urdf_text(strange, "strange"));
  const TakenArm taken = taken_arm(notes, &kInverse, cursor);
  EXPECT_EQ(taken.arm.urdf, own.urdf);
  EXPECT_THAT(taken.why, HasSubstr("has different joints than the device's own arm"));
}

TEST_F(ATakenArm, IsRefusedWhereTheDeviceIsNeverInItsRange) {
  DeviceTraits away = test::pushing(3);
  away.lower = {2, 2, 2};
  away.upper = {3, 3, 3};
  try {
    taken_arm({}, &kRaw, away);
    ADD_FAILURE() << "force anywhere";
  } catch (const UnknownArmError& error) {
    EXPECT_THAT(error.what(), HasSubstr("joint turret goes from -1 to 1 rad in the arm omni, but "
                                        "from 2 to 3 in the device A device"));
    EXPECT_THAT(error.what(), HasSubstr("--arm"));
  }
}

TEST_F(ATakenArm, IsNoOtherOneWhereItsFileIsGone) {
  DeviceNotes notes;
  notes.taken_for = (dir / "gone.urdf").string();
  EXPECT_THROW(taken_arm(notes, &kRaw, traits), FileError);
}

}  // namespace
}  // namespace limpid
