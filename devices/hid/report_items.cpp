#include "devices/hid/report_items.h"

#include <fmt/format.h>

#include "devices/hid/hid_error.h"

namespace limpid {
namespace {

constexpr std::uint8_t kLongItem = 0xFE;
constexpr const char* kCutOff = "the item is cut off";

}  // namespace

std::int64_t ReportItem::as_signed() const {
  if (size == 1) return static_cast<std::int8_t>(value);
  if (size == 2) return static_cast<std::int16_t>(value);
  return static_cast<std::int32_t>(value);
}

void refuse(const ReportItem& item, std::string_view what) {
  throw HidError(fmt::format("report descriptor, byte {}: {}", item.offset, what));
}

std::optional<ReportItem> ReportItems::next() {
  skip_long_items();
  if (at_ == bytes_.size()) return std::nullopt;
  const std::uint8_t prefix = bytes_[at_];
  ReportItem item;
  item.offset = at_;
  item.type = (prefix >> 2) & 3;
  item.tag = prefix >> 4;
  item.size = (prefix & 3) == 3 ? 4 : prefix & 3;
  if (bytes_.size() - at_ - 1 < item.size) refuse(item, kCutOff);
  for (std::size_t i = 0; i < item.size; ++i) {
    item.value |= static_cast<std::uint32_t>(bytes_[at_ + 1 + i]) << (8 * i);
  }
  at_ += 1u + item.size;
  return item;
}

void ReportItems::skip_long_items() {
  while (at_ < bytes_.size() && bytes_[at_] == kLongItem) {
    ReportItem item;
    item.offset = at_;
    const std::size_t left = bytes_.size() - at_;
    if (left < 2 || left < 3u + bytes_[at_ + 1]) refuse(item, kCutOff);
    at_ += 3u + bytes_[at_ + 1];
  }
}

}  // namespace limpid
