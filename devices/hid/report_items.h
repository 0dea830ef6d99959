// The items that a HID report descriptor is a row of (USB HID 1.11, chapter 6.2.2.2).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace limpid {

struct ReportItem {
  enum Type : std::uint8_t { kMain = 0, kGlobal = 1, kLocal = 2 };

  std::size_t offset = 0;  // in the descriptor, for messages
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

  // The next one, or nothing at the end. Throws HidError if it is cut off. Long items, which nobody
  // has ever given a meaning, are passed over.
  std::optional<ReportItem> next();

 private:
  void skip_long_items();

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

}  // namespace limpid
