// HID report descriptors (USB HID 1.11, chapter 6.2.2): what a device says its reports contain.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace limpid {

// An item of a report descriptor (chapter 6.2.2.2).
struct ReportItem {
  enum Type : std::uint8_t { kMain = 0, kGlobal = 1, kLocal = 2 };

  std::size_t offset = 0;  // within the descriptor, for messages
  std::uint8_t type = 0;
  std::uint8_t tag = 0;
  std::uint8_t size = 0;  // of the data [bytes]
  std::uint32_t value = 0;

  std::int64_t as_signed() const;
};

// Throws HidError naming the place of the item.
[[noreturn]] void refuse(const ReportItem& item, std::string_view what);

class ReportItems {
 public:
  explicit ReportItems(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  // Returns the next item, or nothing at the end. Throws HidError if it is cut off. Skips long
  // items, which have never been given a meaning.
  std::optional<ReportItem> next();

 private:
  void skip_long_items();

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

enum class ReportKind : std::uint8_t { input, output, feature };

// A usage: its page in the upper half, the usage within the page in the lower.
using Usage = std::uint32_t;

constexpr Usage make_usage(std::uint16_t page, std::uint16_t id) {
  return static_cast<Usage>(page) << 16 | id;
}

// A value of a report, or several of the same meaning. Padding is left out.
struct ReportField {
  ReportKind kind = ReportKind::input;
  std::uint8_t report_id = 0;    // 0 if the device numbers none
  std::uint32_t bit_offset = 0;  // from the report's first byte, which is its id
  std::uint32_t bit_size = 0;    // of one value, 1 to 32
  std::uint32_t count = 1;       // values, one after the other
  bool array = false;            // the value - logical_min is an index into usages
  std::vector<Usage> usages;     // of an array: all that it can hold; else one, or none
  std::int64_t logical_min = 0;  // range of the number in the report, signed if this is negative
  std::int64_t logical_max = 0;
  std::int64_t physical_min = 0;  // physical range, in units of unit * 10^unit_exponent
  std::int64_t physical_max = 0;
  std::uint32_t unit = 0;  // as in the descriptor, 0 for none
  int unit_exponent = 0;
  std::vector<Usage> collections;  // that contain it, outermost first

  bool within(Usage collection) const;
};

struct ReportDescriptor {
  std::vector<ReportField> fields;
  std::vector<Usage> applications;                              // the outermost collections
  std::array<std::array<std::uint32_t, 256>, 3> report_bits{};  // [kind][id], 0: no such report
  bool numbered = false;

  // Size of a report with its id [bytes]; 0 if there is none.
  std::size_t report_bytes(ReportKind kind, std::uint8_t id) const;

  // The first field that is `usage`, or an array that can hold it, in a collection `within` (0: in
  // any); null if there is none.
  const ReportField* find(ReportKind kind, Usage usage, Usage within = 0) const;
};

// Parses a descriptor. Throws HidError with the offset of the first item that makes no sense.
// Whatever the bytes, no report is longer than the kernel's limit, and time and memory stay small.
ReportDescriptor parse_report_descriptor(std::span<const std::uint8_t> bytes);

// Gets value `index` of the field; nothing if the report is too short for it.
std::optional<std::int64_t> get_field(std::span<const std::uint8_t> report,
                                      const ReportField& field, std::uint32_t index = 0);

// Sets a value. False, and nothing done, if it lies outside the report or the field's bits cannot
// hold the number.
bool put_field(std::span<std::uint8_t> report, const ReportField& field, std::int64_t value,
               std::uint32_t index = 0);

// The fields of buttons 1 to 32 in the input reports, of one bit each.
std::vector<ReportField> button_fields(const ReportDescriptor& descriptor);

// Takes the buttons of a report into `pressed` and `known`, one bit each; true if there are any.
bool decode_buttons(std::span<const std::uint8_t> report, std::span<const ReportField> fields,
                    std::uint32_t& pressed, std::uint32_t& known) noexcept;

}  // namespace limpid
