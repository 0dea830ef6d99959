// Numbers in reports, written for the reference devices alone: nothing of it is shared with the
// code under test.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace limpid::test {

using Report = std::vector<std::uint8_t>;
using ReportView = std::span<const std::uint8_t>;

// Place and range of a number in a report whose first byte is its id.
struct Field {
  std::uint8_t id = 0;
  int offset = 0;  // from the report's beginning [bit]
  int bits = 0;
  std::int32_t min = 0, max = 0;

  // The field `n` places on, of the same size and range.
  Field at(int n) const { return {id, offset + n * bits, bits, min, max}; }
  bool allows(std::int64_t value) const { return value >= min && value <= max; }
};

// Reads the field, signed if its range has negative values; 0 if the report ends before it.
inline std::int64_t get(ReportView report, const Field& field) {
  const auto end = static_cast<std::size_t>(field.offset + field.bits);
  if (end > report.size() * 8) return 0;
  std::uint64_t value = 0;
  for (int i = 0; i < field.bits; ++i) {
    const int bit = field.offset + i;
    const std::uint64_t one = (report[static_cast<std::size_t>(bit / 8)] >> (bit % 8)) & 1U;
    value |= one << i;
  }
  const bool negative = field.min < 0 && ((value >> (field.bits - 1)) & 1U);
  if (negative) value |= ~std::uint64_t{0} << field.bits;
  return static_cast<std::int64_t>(value);
}

inline void put(Report& report, const Field& field, std::int64_t value) {
  for (int i = 0; i < field.bits; ++i) {
    const int bit = field.offset + i;
    const auto mask = static_cast<std::uint8_t>(1U << (bit % 8));
    std::uint8_t& byte = report[static_cast<std::size_t>(bit / 8)];
    const bool set = (static_cast<std::uint64_t>(value) >> i) & 1U;
    byte = static_cast<std::uint8_t>(set ? byte | mask : byte & ~mask);
  }
}

// Little-endian numbers at a byte, stored as in memory here.
static_assert(std::endian::native == std::endian::little);

template <class T>
T read_at(ReportView report, std::size_t byte) {
  T value;
  std::memcpy(&value, report.subspan(byte, sizeof value).data(), sizeof value);
  return value;
}

template <class T>
void write_at(std::span<std::uint8_t> report, std::size_t byte, T value) {
  std::memcpy(report.subspan(byte, sizeof value).data(), &value, sizeof value);
}

// CRC-32 of IEEE 802.3, bit by bit.
inline std::uint32_t crc32_of(ReportView bytes) {
  std::uint32_t crc = ~0U;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int i = 0; i < 8; ++i) crc = (crc >> 1) ^ (crc & 1U ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

}  // namespace limpid::test
