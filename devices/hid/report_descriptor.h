// HID report descriptor (USB HID 1.11, chapter 6.2.2): what a device says its reports contain.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace limpid {

enum class ReportKind : std::uint8_t { input, output, feature };

// Usage page in the upper half, usage within it in the lower.
using Usage = std::uint32_t;

constexpr Usage make_usage(std::uint16_t page, std::uint16_t id) {
  return static_cast<Usage>(page) << 16 | id;
}

// One value of a report, or several of the same meaning. Padding is left out.
struct ReportField {
  ReportKind kind = ReportKind::input;
  std::uint8_t report_id = 0;    // 0 where the device numbers none
  std::uint32_t bit_offset = 0;  // from the report's first byte, which is its id
  std::uint32_t bit_size = 0;    // of one value, 1 to 32
  std::uint32_t count = 1;       // values, one after the other
  bool array = false;            // the value - logical_min is an index into usages
  std::vector<Usage> usages;     // array: all it can say; else one, or none
  std::int64_t logical_min = 0;  // of the number in the report, signed if this is negative
  std::int64_t logical_max = 0;
  std::int64_t physical_min = 0;  // what these stand for, in units of unit * 10^unit_exponent
  std::int64_t physical_max = 0;
  std::uint32_t unit = 0;  // as in the descriptor, 0 for none
  int unit_exponent = 0;
  std::vector<Usage> collections;  // that it lies in, outermost first

  bool within(Usage collection) const;
};

struct ReportDescriptor {
  std::vector<ReportField> fields;
  std::vector<Usage> applications;                              // the outermost collections
  std::array<std::array<std::uint32_t, 256>, 3> report_bits{};  // [kind][id], 0: no such report
  bool numbered = false;

  // Size of a report with its id [bytes]; 0 if there is none.
  std::size_t report_bytes(ReportKind kind, std::uint8_t id) const;

  // The first field that is, or as an array can say, `usage`, in a collection `within` (0: in any);
  // null if there is none.
  const ReportField* find(ReportKind kind, Usage usage, Usage within = 0) const;
};

// Throws HidError with the offset of the first item that makes no sense. Whatever the bytes, no
// report is longer than the kernel's limit and time and memory stay small.
ReportDescriptor parse_report_descriptor(std::span<const std::uint8_t> bytes);

}  // namespace limpid
