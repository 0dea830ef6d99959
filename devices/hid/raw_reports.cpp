#include "devices/hid/raw_reports.h"

namespace limpid {
namespace {

constexpr std::size_t kCrcSize = 4;

std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0u);
  }
  return ~crc;
}

}  // namespace

void seal_raw_bytes(std::span<std::uint8_t> bytes) {
  const std::size_t end = bytes.size() - kCrcSize;
  store_le(bytes, end, crc32(bytes.first(end)));
}

bool raw_undamaged(std::span<const std::uint8_t> bytes, std::uint8_t version, std::size_t size) {
  if (bytes.size() != size || bytes[RawAt::magic] != kRawMagic ||
      bytes[RawAt::version] != version) {
    return false;
  }
  const std::size_t end = size - kCrcSize;
  return load_le<std::uint32_t>(bytes, end) == crc32(bytes.first(end));
}

}  // namespace limpid
