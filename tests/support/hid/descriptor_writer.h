// Writes a HID report descriptor and returns the place of each field.
#pragma once

#include <map>
#include <utility>

#include "tests/support/hid/report_bits.h"

namespace limpid::test {

class DescriptorWriter {
 public:
  enum class Kind : std::uint8_t { input = 0x80, output = 0x90, feature = 0xB0 };
  enum Flags : std::uint8_t { kArray = 0x00, kPadding = 0x01, kVariable = 0x02, kRelative = 0x06 };
  enum Collection : std::uint8_t { kPhysical = 0, kApplication = 1, kLogical = 2 };

  DescriptorWriter& page(std::uint16_t page) { return item(0x04, page, wide(page)); }
  DescriptorWriter& usage(std::uint16_t usage) { return item(0x08, usage, wide(usage)); }
  DescriptorWriter& usages(std::initializer_list<std::uint8_t> list) {
    for (const std::uint8_t one : list) usage(one);
    return *this;
  }
  DescriptorWriter& usages(std::uint8_t first, std::uint8_t last) {
    return item(0x18, first, 1).item(0x28, last, 1);
  }
  DescriptorWriter& begin(Collection kind) { return item(0xA0, kind, 1); }
  DescriptorWriter& end() { return item(0xC0, 0, 0); }
  // Puts the following fields into report `id`.
  DescriptorWriter& report(std::uint8_t id) {
    id_ = id;
    return item(0x84, id, 1);
  }
  DescriptorWriter& logical(std::int32_t min, std::int32_t max) {
    min_ = min;
    max_ = max;
    return signed_item(0x14, min).signed_item(0x24, max);
  }
  // Physical range; 0 and 0 stand for none.
  DescriptorWriter& physical(std::int32_t min, std::int32_t max) {
    return signed_item(0x34, min).signed_item(0x44, max);
  }
  // Unit and its exponent of ten, -8 to 7.
  DescriptorWriter& unit(std::uint16_t unit, int exponent) {
    return item(0x64, unit, wide(unit)).item(0x54, static_cast<std::uint32_t>(exponent) & 0xFU, 1);
  }
  // Adds `count` fields; returns the first of them.
  Field field(Kind kind, int bits, int count, Flags flags = kVariable) {
    item(0x74, static_cast<std::uint32_t>(bits), 1);
    item(0x94, static_cast<std::uint32_t>(count), 1);
    item(static_cast<std::uint8_t>(kind), flags, 1);
    int& used = used_[{kind, id_}];
    const Field first{id_, 8 + used, bits, min_, max_};
    used += bits * count;
    return first;
  }
  DescriptorWriter& padding(Kind kind, int bits) {
    field(kind, bits, 1, kPadding);
    return *this;
  }

  const Report& descriptor() const { return bytes_; }
  // An empty report; its first byte is `id`, even 0.
  Report blank(Kind kind, std::uint8_t id) const {
    Report report(static_cast<std::size_t>(1 + (used_.at({kind, id}) + 7) / 8));
    report[0] = id;
    return report;
  }

 private:
  static int wide(std::uint32_t value) { return value > 0xFF ? 2 : 1; }
  DescriptorWriter& item(std::uint8_t tag, std::uint32_t value, int size) {
    bytes_.push_back(static_cast<std::uint8_t>(tag | (size == 4 ? 3 : size)));
    for (int i = 0; i < size; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    return *this;
  }
  DescriptorWriter& signed_item(std::uint8_t tag, std::int32_t value) {
    const bool small = value >= -128 && value <= 127;
    const bool medium = value >= -32768 && value <= 32767;
    return item(tag, static_cast<std::uint32_t>(value), small ? 1 : medium ? 2 : 4);
  }

  Report bytes_;
  std::map<std::pair<Kind, std::uint8_t>, int> used_;  // [bit]
  std::uint8_t id_ = 0;
  std::int32_t min_ = 0, max_ = 0;
};

}  // namespace limpid::test
