#include "devices/hid/report_fields.h"

namespace limpid {
namespace {

// The first bit of the value, or nothing if the value is not all in the report.
std::optional<std::uint64_t> first_bit(std::size_t bytes, const ReportField& field,
                                       std::uint32_t index) {
  const std::uint64_t first = field.bit_offset + static_cast<std::uint64_t>(index) * field.bit_size;
  if (field.bit_size < 1 || field.bit_size > 32 || index >= field.count ||
      first + field.bit_size > 8 * static_cast<std::uint64_t>(bytes)) {
    return std::nullopt;
  }
  return first;
}

bool fits(std::int64_t value, const ReportField& field) {
  const std::int64_t values = std::int64_t{1} << field.bit_size;
  if (field.logical_min < 0) return value >= -values / 2 && value < values / 2;
  return value >= 0 && value < values;
}

}  // namespace

std::optional<std::int64_t> get_field(std::span<const std::uint8_t> report,
                                      const ReportField& field, std::uint32_t index) {
  const auto first = first_bit(report.size(), field, index);
  if (!first) return std::nullopt;
  std::int64_t value = 0;
  for (std::uint32_t i = 0; i < field.bit_size; ++i) {
    const std::uint64_t bit = *first + i;
    value |= static_cast<std::int64_t>(report[bit / 8] >> (bit % 8) & 1) << i;
  }
  const std::int64_t sign = std::int64_t{1} << (field.bit_size - 1);
  const bool negative = field.logical_min < 0 && (value & sign);
  return negative ? value - 2 * sign : value;
}

bool put_field(std::span<std::uint8_t> report, const ReportField& field, std::int64_t value,
               std::uint32_t index) {
  const auto first = first_bit(report.size(), field, index);
  if (!first || !fits(value, field)) return false;
  for (std::uint32_t i = 0; i < field.bit_size; ++i) {
    const std::uint64_t bit = *first + i;
    const auto mask = static_cast<std::uint8_t>(1u << (bit % 8));
    std::uint8_t& byte = report[bit / 8];
    byte = static_cast<std::uint8_t>((value >> i & 1) ? byte | mask : byte & ~mask);
  }
  return true;
}

}  // namespace limpid
