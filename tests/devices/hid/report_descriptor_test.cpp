#include "devices/hid/report_descriptor.h"

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <utility>

#include "devices/hid/hid_transport.h"
#include "devices/hid/pid_reports.h"
#include "tests/support/hid_descriptors.h"

namespace limpid {
namespace {

using test::Bytes;
using test::operator+;

constexpr Usage kX = make_usage(1, 0x30);

std::string complaint_of_parser(const Bytes& bytes) {
  try {
    parse_report_descriptor(bytes);
  } catch (const HidError& error) {
    return error.what();
  }
  return "none";
}

TEST(ReportDescriptor, FindsTheSpaceNavigatorsAxesInTheirTwoReports) {
  const ReportDescriptor d = parse_report_descriptor(test::space_navigator());
  EXPECT_TRUE(d.numbered);
  EXPECT_EQ(d.applications, std::vector<Usage>{make_usage(1, 8)});
  EXPECT_EQ(d.report_bytes(ReportKind::input, 1), 7u);
  EXPECT_EQ(d.report_bytes(ReportKind::input, 3), 3u);
  EXPECT_EQ(d.report_bytes(ReportKind::output, 4), 2u);
  EXPECT_EQ(d.report_bytes(ReportKind::output, 1), 0u);
  const ReportField* rz = d.find(ReportKind::input, make_usage(1, 0x35));
  ASSERT_TRUE(rz);
  EXPECT_EQ(rz->report_id, 2);
  EXPECT_EQ(rz->bit_offset, 8u + 32u);
  EXPECT_EQ(rz->bit_size, 16u);
  EXPECT_EQ(rz->logical_min, -350);
  EXPECT_EQ(rz->logical_max, 350);
  EXPECT_EQ(rz->physical_max, 1400);
  EXPECT_EQ(rz->unit, 0x11u);
  EXPECT_EQ(rz->unit_exponent, -4);
}

TEST(ReportDescriptor, KeepsReportsOfDifferentKindsWithOneIdApart) {
  const ReportDescriptor d = parse_report_descriptor(test::pid_joystick::whole());
  EXPECT_EQ(d.report_bytes(ReportKind::output, 5), 4u);
  EXPECT_EQ(d.report_bytes(ReportKind::feature, 5), 4u);
  EXPECT_EQ(d.report_bytes(ReportKind::input, 1), 6u);
  EXPECT_EQ(d.report_bytes(ReportKind::output, 1), 12u);
}

TEST(ReportDescriptor, ReadsTheFieldsOfAPidEffect) {
  const ReportDescriptor d = parse_report_descriptor(test::pid_joystick::whole());
  const ReportField* type = d.find(ReportKind::output, pid::kTypeConstantForce, pid::kSetEffect);
  ASSERT_TRUE(type);
  EXPECT_TRUE(type->array);
  EXPECT_EQ(type->usages.size(), 3u);
  const ReportField* duration = d.find(ReportKind::output, pid::kDuration, pid::kSetEffect);
  ASSERT_TRUE(duration);
  EXPECT_EQ(duration->bit_offset, 24u);
  EXPECT_EQ(duration->unit, 0x1003u);
  EXPECT_EQ(duration->unit_exponent, -3);
  // A minimum from 0 on makes 0x00FF 255, one below makes 0xFF01 -255.
  const ReportField* force = d.find(ReportKind::output, pid::kMagnitude, pid::kSetConstantForce);
  ASSERT_TRUE(force);
  EXPECT_EQ(force->logical_min, -255);
  EXPECT_EQ(force->logical_max, 255);
  EXPECT_EQ(force->physical_min, -10000);
  // X is an axis and, within Axes Enable, a switch.
  EXPECT_EQ(d.find(ReportKind::output, kX, pid::kAxesEnable)->bit_size, 1u);
  EXPECT_EQ(d.find(ReportKind::output, make_usage(0x0A, 2), pid::kDirection)->bit_offset,
            8u + 8u + 8u + 32u + 8u + 8u + 8u + 8u);
}

TEST(ReportDescriptor, LeavesPlaceForTheIdWhereThereIsNone) {
  const ReportDescriptor d = parse_report_descriptor(test::raw_device());
  EXPECT_FALSE(d.numbered);
  EXPECT_EQ(d.report_bytes(ReportKind::input, 0), 65u);
  EXPECT_EQ(d.report_bytes(ReportKind::feature, 0), 65u);
  ASSERT_EQ(d.fields.size(), 3u);
  EXPECT_EQ(d.fields[0].bit_offset, 8u);
  EXPECT_EQ(d.fields[0].count, 64u);
}

TEST(ReportDescriptor, RestoresGlobalsAtAPop) {
  const Bytes bytes{0x05, 0x01, 0x75, 0x08, 0x95, 0x01, 0x15, 0x81, 0x25, 0x7F, 0xA4,
                    0x75, 0x10, 0x09, 0x30, 0x81, 0x02, 0xB4, 0x09, 0x31, 0x81, 0x02};
  const ReportDescriptor d = parse_report_descriptor(bytes);
  ASSERT_EQ(d.fields.size(), 2u);
  EXPECT_EQ(d.fields[0].bit_size, 16u);
  EXPECT_EQ(d.fields[1].bit_size, 8u);
  EXPECT_EQ(d.fields[1].bit_offset, 8u + 16u);
}

TEST(ReportDescriptor, TakesTheFirstOfAlternativeUsages) {
  const Bytes bytes{0x05, 0x01, 0x75, 0x08, 0x95, 0x01, 0xA9, 0x01,
                    0x09, 0x30, 0x09, 0x31, 0xA9, 0x00, 0x81, 0x02};
  const ReportDescriptor d = parse_report_descriptor(bytes);
  EXPECT_TRUE(d.find(ReportKind::input, kX));
  EXPECT_FALSE(d.find(ReportKind::input, make_usage(1, 0x31)));
}

// Each value has a set of alternatives: X or Y, Z or Rx, and Ry alone.
TEST(ReportDescriptor, TakesTheFirstOfEachSetOfAlternatives) {
  const Bytes bytes{0x05, 0x01, 0x75, 0x08, 0x95, 0x03,              //
                    0xA9, 0x01, 0x09, 0x30, 0x09, 0x31, 0xA9, 0x00,  //
                    0xA9, 0x01, 0x09, 0x32, 0x09, 0x33, 0xA9, 0x00,  //
                    0x09, 0x34, 0x81, 0x02};
  const ReportDescriptor d = parse_report_descriptor(bytes);
  ASSERT_EQ(d.fields.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    const ReportField& field = d.fields[static_cast<std::size_t>(i)];
    EXPECT_EQ(field.usages,
              std::vector<Usage>{make_usage(1, static_cast<std::uint16_t>(0x30 + 2 * i))});
    EXPECT_EQ(field.bit_offset, 8u + 8u * static_cast<unsigned>(i));
    EXPECT_EQ(field.count, 1u);
  }
}

// A range among alternatives is a single alternative: it must not shift the following ones.
TEST(ReportDescriptor, TakesNoRangeBesideAnAlternative) {
  const Bytes bytes{0x05, 0x01, 0x75, 0x08, 0x95, 0x02, 0xA9, 0x01, 0x09, 0x30,
                    0x19, 0x33, 0x29, 0x35, 0xA9, 0x00, 0x09, 0x31, 0x81, 0x02};
  const ReportDescriptor d = parse_report_descriptor(bytes);
  ASSERT_EQ(d.fields.size(), 2u);
  EXPECT_EQ(d.fields[0].usages, std::vector<Usage>{kX});
  EXPECT_EQ(d.fields[1].usages, std::vector<Usage>{make_usage(1, 0x31)});
}

// More values than usages: the last usage has all the remaining values.
TEST(ReportDescriptor, GivesTheLastUsageAllValuesThatRemain) {
  const Bytes bytes{0x05, 0x01, 0x75, 0x04, 0x95, 0x05, 0x09, 0x30, 0x09, 0x31,
                    0x81, 0x02, 0x75, 0x08, 0x95, 0x01, 0x09, 0x32, 0x81, 0x02};
  const ReportDescriptor d = parse_report_descriptor(bytes);
  ASSERT_EQ(d.fields.size(), 3u);
  EXPECT_EQ(d.fields[0].count, 1u);
  EXPECT_EQ(d.fields[1].count, 4u);
  EXPECT_EQ(d.fields[1].bit_offset, 8u + 4u);
  EXPECT_EQ(d.fields[2].bit_offset, 8u + 20u);
  EXPECT_EQ(d.report_bytes(ReportKind::input, 0), 5u);  // the id's place and 28 bits
  const Bytes report{0, 0x21, 0x43, 0x65, 0x07};
  for (std::uint32_t i = 0; i < 4; ++i) {
    EXPECT_EQ(get_field(report, d.fields[1], i), 2 + static_cast<int>(i));
  }
  EXPECT_EQ(get_field(report, d.fields[1], 4), std::nullopt);
  EXPECT_EQ(get_field(report, d.fields[2]), 0x76);
}

// Fewer values than usages: usages without a value make no field.
TEST(ReportDescriptor, HasNoFieldForAUsageWithoutAValue) {
  const Bytes bytes{0x05, 0x01, 0x75, 0x08, 0x95, 0x01, 0x09, 0x30, 0x09, 0x31, 0x81, 0x02};
  const ReportDescriptor d = parse_report_descriptor(bytes);
  EXPECT_EQ(d.fields.size(), 1u);
  EXPECT_FALSE(d.find(ReportKind::input, make_usage(1, 0x31)));
}

// Each range follows its own minimum: a maximum is signed only where the minimum is below 0.
TEST(ReportDescriptor, ReadsTheSignOfEachMaximumFromItsOwnMinimum) {
  struct Case {
    Bytes range;
    std::array<std::int64_t, 4> expected;  // logical, physical
  };
  const Case cases[] = {
      // 36000 in two bytes beside a signed logical range.
      {{0x15, 0x81, 0x25, 0x7F, 0x35, 0x00, 0x46, 0xA0, 0x8C}, {-127, 127, 0, 36000}},
      // -100 in one byte beside an unsigned logical range.
      {{0x15, 0x00, 0x25, 0xFF, 0x36, 0xD4, 0xFE, 0x45, 0x9C}, {0, 255, -300, -100}},
      {{0x15, 0x00, 0x25, 0xFF, 0x36, 0xF0, 0xD8, 0x46, 0x88, 0x13}, {0, 255, -10000, 5000}},
      {{0x16, 0x00, 0x80, 0x26, 0xFF, 0x7F, 0x35, 0x0A, 0x45, 0xC8}, {-32768, 32767, 10, 200}},
      // Without a physical range the logical one holds, not 0.
      {{0x15, 0xF6, 0x25, 0x14, 0x35, 0x00, 0x45, 0x00}, {-10, 20, -10, 20}},
      {{0x15, 0xF6, 0x25, 0x14, 0x35, 0x00, 0x45, 0x01}, {-10, 20, 0, 1}},
  };
  for (const Case& one : cases) {
    const Bytes field{0x05, 0x01, 0x75, 0x10, 0x95, 0x01, 0x09, 0x30, 0x81, 0x02};
    const ReportDescriptor d = parse_report_descriptor(one.range + field);
    ASSERT_EQ(d.fields.size(), 1u);
    const ReportField& f = d.fields[0];
    EXPECT_EQ((std::array{f.logical_min, f.logical_max, f.physical_min, f.physical_max}),
              one.expected);
  }
}

// Exponents are four bits by the standard, and a signed byte in many devices.
TEST(ReportDescriptor, ReadsExponentsAsDevicesWriteThem) {
  const std::pair<std::uint8_t, int> cases[] = {{0x00, 0},  {0x07, 7},  {0x08, -8},
                                                {0x0D, -3}, {0x0F, -1}, {0xFD, -3}};
  for (const auto& [byte, exponent] : cases) {
    const Bytes bytes{0x55, byte, 0x75, 0x08, 0x95, 0x01, 0x81, 0x02};
    EXPECT_EQ(parse_report_descriptor(bytes).fields.at(0).unit_exponent, exponent);
  }
}

// Usages of a main item are not there for the next.
TEST(ReportDescriptor, ForgetsUsagesAfterEachItem) {
  const Bytes bytes{0x05, 0x01, 0x75, 0x08, 0x95, 0x01, 0x09, 0x30, 0x81, 0x02, 0x81, 0x02};
  const ReportDescriptor d = parse_report_descriptor(bytes);
  ASSERT_EQ(d.fields.size(), 2u);
  EXPECT_TRUE(d.fields[1].usages.empty());
}

TEST(ReportDescriptor, SkipsLongItems) {
  const Bytes bytes = Bytes{0xFE, 0x02, 0x42, 0xAA, 0xBB} + test::space_navigator();
  EXPECT_TRUE(parse_report_descriptor(bytes).find(ReportKind::input, kX));
}

TEST(ReportDescriptor, RefusesWhatMakesNoSense) {
  const auto contains = [](const Bytes& bytes, const char* text) {
    EXPECT_NE(complaint_of_parser(bytes).find(text), std::string::npos)
        << complaint_of_parser(bytes);
  };
  contains({0x05, 0x01, 0x26, 0xFF}, "byte 2: the end of the item is missing");
  contains({0xFE}, "the end of the item");
  contains({0xFE, 0x20, 0x00, 0x01}, "the end of the item");
  contains({0xC0}, "closes a collection");
  contains({0x09, 0x01, 0xA1, 0x01}, "not closed");
  contains({0x85, 0x00}, "id is 1 to 255");
  contains({0x86, 0x00, 0x01}, "id is 1 to 255");
  contains({0xB4}, "pop");
  contains({0x75, 0x08, 0x95, 0x01, 0x81, 0x02, 0x85, 0x01}, "have an id, others have none");
  // 2^32 - 1 values of 2^32 - 1 bits.
  contains({0x77, 0xFF, 0xFF, 0xFF, 0xFF, 0x97, 0xFF, 0xFF, 0xFF, 0xFF, 0x81, 0x02}, "too long");
  contains({0x75, 0x01, 0x97, 0x00, 0x00, 0x01, 0x00, 0x81, 0x02}, "too long");
  contains(Bytes(5000, 0xC0), "at most 4096");
  Bytes deep;
  for (int i = 0; i < 100; ++i) deep = deep + Bytes{0xA1, 0x01};
  contains(deep, "nested too deeply");
  contains(Bytes(100, 0xA4), "too many pushes");
  Bytes many{0x75, 0x01, 0x95, 0xFF, 0x05, 0x09, 0x09, 0x01};
  for (int i = 0; i < 10; ++i) many = many + Bytes{0x19, 0x01, 0x29, 0xFF, 0x81, 0x02};
  contains(many, "too many fields");
}

TEST(ReportDescriptor, KeepsAHugeRangeOfUsagesSmall) {
  const Bytes bytes{0x75, 0x08, 0x95, 0x01, 0x1B, 0,    0,    0,
                    0,    0x2B, 0xFF, 0xFF, 0xFF, 0xFF, 0x81, 0x00};
  const ReportDescriptor d = parse_report_descriptor(bytes);
  ASSERT_EQ(d.fields.size(), 1u);
  EXPECT_LE(d.fields[0].usages.size(), 1024u);
}

}  // namespace
}  // namespace limpid
