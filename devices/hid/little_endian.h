// Numbers as bytes, the lowest first, whatever the computer's own order.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <span>

namespace limpid {

// The bytes at..at + sizeof(T) - 1 must exist.
template <std::unsigned_integral T>
T load_le(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = sizeof(T); i-- > 0;) value = value << 8 | bytes[at + i];
  return static_cast<T>(value);
}

template <std::unsigned_integral T>
void store_le(std::span<std::uint8_t> bytes, std::size_t at, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bytes[at + i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
  }
}

inline float load_float_le(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::bit_cast<float>(load_le<std::uint32_t>(bytes, at));
}

inline void store_float_le(std::span<std::uint8_t> bytes, std::size_t at, float value) {
  store_le(bytes, at, std::bit_cast<std::uint32_t>(value));
}

}  // namespace limpid
