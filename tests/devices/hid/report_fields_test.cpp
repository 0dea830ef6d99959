#include <gtest/gtest.h>

#include "devices/hid/report_descriptor.h"

namespace limpid {
namespace {

ReportField field(std::uint32_t offset, std::uint32_t bits, std::int64_t minimum) {
  ReportField f;
  f.bit_offset = offset;
  f.bit_size = bits;
  f.logical_min = minimum;
  return f;
}

// 10 bits from bit 12 on: the upper half of byte 1 and six bits of byte 2.
TEST(ReportFields, ReadsBitsAcrossBytesLowestFirst) {
  const std::vector<std::uint8_t> report{0x00, 0xA0, 0x15};
  EXPECT_EQ(get_field(report, field(12, 10, 0)), 0x15A);
}

TEST(ReportFields, ReadsNegativeNumbersWhereTheyAreDeclared) {
  const std::vector<std::uint8_t> report{0xFE, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(get_field(report, field(0, 16, -100)), -2);
  EXPECT_EQ(get_field(report, field(0, 16, 0)), 0xFFFE);
  EXPECT_EQ(get_field(report, field(0, 32, -1)), -2);
  EXPECT_EQ(get_field(report, field(0, 32, 0)), 0xFFFFFFFE);
  EXPECT_EQ(get_field(report, field(1, 1, -1)), -1);
}

TEST(ReportFields, PutsWhatItGetsAndTouchesNothingElse) {
  for (const std::int64_t minimum : {std::int64_t{-512}, std::int64_t{0}}) {
    for (std::int64_t value = minimum; value < minimum + 1024; ++value) {
      std::vector<std::uint8_t> report(4, 0xFF);
      ASSERT_TRUE(put_field(report, field(11, 10, minimum), value));
      ASSERT_EQ(get_field(report, field(11, 10, minimum)), value);
      EXPECT_EQ(get_field(report, field(0, 11, 0)), 0x7FF);
      EXPECT_EQ(get_field(report, field(21, 11, 0)), 0x7FF);
    }
  }
}

TEST(ReportFields, PutsTheWordsOfALargeField) {
  ReportField f = field(8, 16, 0);
  f.count = 2;
  std::vector<std::uint8_t> report(5);
  EXPECT_TRUE(put_field(report, f, 0x1234, 1));
  EXPECT_EQ(report, (std::vector<std::uint8_t>{0, 0, 0, 0x34, 0x12}));
  EXPECT_FALSE(put_field(report, f, 1, 2));
}

TEST(ReportFields, StaysInsideTheReport) {
  std::vector<std::uint8_t> report(3, 0x55);
  EXPECT_FALSE(get_field(report, field(9, 16, 0)));
  EXPECT_FALSE(put_field(report, field(9, 16, 0), 0));
  EXPECT_FALSE(get_field({}, field(0, 1, 0)));
  EXPECT_FALSE(get_field(report, field(0xFFFFFFFF, 32, 0)));
  EXPECT_EQ(report, std::vector<std::uint8_t>(3, 0x55));
}

TEST(ReportFields, RefusesNumbersThatTheBitsCannotHold) {
  std::vector<std::uint8_t> report(2);
  EXPECT_FALSE(put_field(report, field(0, 8, 0), 256));
  EXPECT_FALSE(put_field(report, field(0, 8, 0), -1));
  EXPECT_FALSE(put_field(report, field(0, 8, -1), 128));
  EXPECT_TRUE(put_field(report, field(0, 8, -1), -128));
}

}  // namespace
}  // namespace limpid
