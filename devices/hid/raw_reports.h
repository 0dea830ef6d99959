// Bytes of the raw protocol's reports, for both ends: places, numbers, check sums. raw_protocol.h
// is the page that explains them.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "devices/device.h"

namespace limpid {

// Little-endian numbers in bytes, on any computer. The bytes at..at + sizeof(T) - 1 must exist.
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

inline constexpr std::uint8_t kRawMagic = 0x4C;

// Sizes of the reports of a version, without an id, and what else differs.
struct RawLayout {
  std::uint8_t version;
  std::size_t joints;  // that there is room for
  std::size_t feature, reading, command;
  std::size_t answered;  // place of the sequence that follows the values of the joints
};
inline constexpr RawLayout kRaw1{1, 6, 64, 64, 64, 40};
inline constexpr RawLayout kRaw2{2, 8, 256, 128, 64, 48};

// Places that reports of both versions have in common.
struct RawAt {
  enum : std::size_t { magic, version, joints, flags, sequence = 4, time_stamp = 8, values = 16 };
  enum : std::size_t { rate = 4, watchdog = 6 };  // in the feature report
};

// Places in the feature report of version 1.
struct Raw1Feature {
  enum : std::size_t { ranges = 8, resolution = 32, limits = 36, name = 48, name_end = 60 };
};

// Places in the feature report and the readings of version 2.
struct Raw2Feature {
  enum : std::size_t {
    kinds = 8,
    lower = 16,
    upper = 48,
    resolution = 80,
    effort = 112,
    speed = 144,
    name = 176,
    made_by = 224,
    end = 252
  };
};
struct Raw2Reading {
  enum : std::size_t { buttons = 52, no_force = 56, warmth = 60, orientation = 64, measured = 80 };
};

struct RawFlag {
  enum : std::uint8_t { motors = 1 };  // in the feature report
  enum : std::uint8_t { power = 1, hand = 2, calibrated = 4, fault = 8, cut = 16 };  // in readings
};
enum class RawMode : std::uint8_t { no_torque = 0, torque = 1 };

// Writes the check sum of a report, without an id, into its last four bytes.
void seal_raw_bytes(std::span<std::uint8_t> bytes);
// Whether a report, without an id, has this magic, version and size, and its own check sum.
bool raw_undamaged(std::span<const std::uint8_t> bytes, std::uint8_t version, std::size_t size);

}  // namespace limpid
