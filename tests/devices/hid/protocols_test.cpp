#include "devices/hid/protocols.h"

#include <gtest/gtest.h>

#include <array>

namespace limpid {
namespace {

bool any(const ReportDescriptor&) { return true; }
bool none(const ReportDescriptor&) { return false; }

constexpr std::array<HidProtocolEntry, 3> kTable{{
    {{.key = "theirs"}, any, nullptr, nullptr, 0xfeed},
    {{.key = "nobody's"}, none, nullptr, nullptr, 0xbeef},
    {{.key = "anybody's"}, any, nullptr, nullptr},
}};

std::string found(std::uint16_t vendor) {
  const HidProtocolEntry* entry = find_protocol({}, vendor, kTable);
  return entry == nullptr ? "" : entry->kind.key;
}

TEST(HidProtocols, OneOfAMakerIsForThatMakersDevicesOnly) {
  EXPECT_EQ(found(0xfeed), "theirs");
  EXPECT_EQ(found(0xfeee), "anybody's");
  EXPECT_EQ(found(0), "anybody's");
}

TEST(HidProtocols, AMakersNumberAloneDescribesNothing) { EXPECT_EQ(found(0xbeef), "anybody's"); }

}  // namespace
}  // namespace limpid
