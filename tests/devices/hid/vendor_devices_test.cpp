#include "devices/hid/vendor_devices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "devices/hid/vendor_kinds.h"

namespace limpid {
namespace {

const VendorLine kLibrary{"openhaptics", false, "/usr/lib/libHD.so.3.4", "", "", false, "3.4"};
const VendorLine kAbsent{"forcedimension", false, "", "", "libdhd.so.3 is not installed", true};
const VendorLine kTouch{"openhaptics", true, "Left Device", "Left Device (OpenHaptics)", "", false};

std::vector<std::string> ids(const std::vector<FoundDevice>& found) {
  std::vector<std::string> all;
  for (const FoundDevice& each : found) all.push_back(each.place.id);
  return all;
}

TEST(VendorDevices, AreListedByTheirBackEndAndName) {
  const auto found = list_vendor_devices({kLibrary, kTouch, kAbsent}, "");
  ASSERT_EQ(ids(found), (std::vector<std::string>{"openhaptics:Left Device"}));
  EXPECT_EQ(found[0].place.name, "Left Device (OpenHaptics)");
  EXPECT_EQ(found[0].missing, "");
  EXPECT_EQ(found[0].place.library, "/usr/lib/libHD.so.3.4");
  EXPECT_EQ(found[0].version, "3.4");
  EXPECT_STREQ(found[0].kind->name, "OpenHaptics device");
  EXPECT_STREQ(found[0].kind->arm, "openhaptics.urdf");
  EXPECT_TRUE(found[0].kind->pushes);
  EXPECT_EQ(found[0].claim_key(found[0]), "vendor:openhaptics:Left Device");
}

TEST(VendorDevices, HaveTheWantedOneWhetherOrNotTheLibraryTellsIt) {
  const auto with = [](const std::string& wanted) {
    return list_vendor_devices({kLibrary, kTouch, kAbsent}, wanted);
  };
  EXPECT_EQ(with("openhaptics:Left Device").size(), 1u) << "once";
  EXPECT_EQ(ids(with("openhaptics:Default Device")),
            (std::vector<std::string>{"openhaptics:Left Device", "openhaptics:Default Device"}));
  const auto missing = with("forcedimension:0");
  ASSERT_EQ(missing.size(), 2u);
  EXPECT_EQ(missing[1].missing, "libdhd.so.3 is not installed");
  EXPECT_EQ(missing[1].place.library, "");
  EXPECT_EQ(with("socket:0").size(), 1u);
}

TEST(VendorDevices, AreNoneOfABackEndThatIsNotKnown) {
  const VendorLine other{"another", true, "0", "Another", "", false};
  EXPECT_TRUE(list_vendor_devices({other}, "another:0").empty());
  EXPECT_EQ(vendor_kind("another:0"), nullptr);
  EXPECT_EQ(vendor_kind("forcedimension"), nullptr) << "no name";
  EXPECT_STREQ(vendor_kind("forcedimension:0")->key, "forcedimension");
}

TEST(VendorDevices, HaveTheArmThatTheListOfMakersNames) {
  std::vector<std::string> keys;
#define KEY(key, name, maker, ...) keys.push_back(#key);
  LIMPID_VENDORS(KEY)
#undef KEY
  EXPECT_THAT(keys, testing::IsSupersetOf({"openhaptics", "forcedimension"}));
  for (const std::string& key : keys) {
    const DeviceKind* const kind = vendor_kind(key + ":0");
    ASSERT_NE(kind, nullptr) << key;
    EXPECT_TRUE(std::filesystem::exists(std::string(LIMPID_ASSETS_DIR "/devices/") + kind->arm));
  }
}

// The program is not beside this one.
TEST(VendorDevices, AreNoneWithoutTheProgram) {
  EXPECT_TRUE(ask_vendors().empty());
  EXPECT_THROW(open_vendor("openhaptics", "Default Device"), HidError);
}

}  // namespace
}  // namespace limpid
