#include "devices/hid/raw_device.h"

#include <algorithm>
#include <cmath>

namespace limpid {
namespace {

void store_text(std::span<std::uint8_t> to, const std::string& text) {
  std::transform(text.begin(), text.begin() + static_cast<long>(std::min(text.size(), to.size())),
                 to.begin(), [](char c) { return c > 0 ? static_cast<std::uint8_t>(c) : '?'; });
}

void store_header(std::span<std::uint8_t> bytes, std::size_t joints, std::uint8_t flags) {
  bytes[RawAt::magic] = kRawMagic;
  bytes[RawAt::version] = kRaw2.version;
  bytes[RawAt::joints] = static_cast<std::uint8_t>(joints);
  bytes[RawAt::flags] = flags;
}

}  // namespace

std::array<std::uint8_t, kRaw2.feature> raw_feature(const RawDescription& description) {
  std::array<std::uint8_t, kRaw2.feature> bytes{};
  const std::span<std::uint8_t> all(bytes);
  const auto number = [&](std::size_t at, std::size_t joint, double value) {
    store_float_le(all, at + 4 * joint, static_cast<float>(value));
  };
  store_header(all, description.joints.size(), description.pushes ? RawFlag::motors : 0);
  store_le(all, RawAt::rate, description.rate);
  store_le(all, RawAt::watchdog, description.watchdog);
  for (std::size_t i = 0; i < std::min(description.joints.size(), kRaw2.joints); ++i) {
    const RawJoint& joint = description.joints[i];
    bytes[Raw2Feature::kinds + i] = joint.slides ? 1 : 0;
    number(Raw2Feature::lower, i, joint.lower);
    number(Raw2Feature::upper, i, joint.upper);
    number(Raw2Feature::resolution, i, joint.resolution);
    number(Raw2Feature::effort, i, joint.effort);
    number(Raw2Feature::speed, i, joint.speed);
  }
  store_text(all.subspan(Raw2Feature::name, Raw2Feature::made_by - Raw2Feature::name),
             description.name);
  store_text(all.subspan(Raw2Feature::made_by, Raw2Feature::end - Raw2Feature::made_by),
             description.made_by);
  seal_raw_bytes(all);
  return bytes;
}

std::array<std::uint8_t, kRaw2.reading> raw_reading(const RawState& state, std::size_t joints) {
  std::array<std::uint8_t, kRaw2.reading> bytes{};
  const std::span<std::uint8_t> all(bytes);
  store_header(all, joints, state.flags);
  store_le(all, RawAt::sequence, state.sequence);
  store_le(all, RawAt::time_stamp, state.time_stamp);
  for (std::size_t i = 0; i < std::min(joints, kRaw2.joints); ++i) {
    store_float_le(all, RawAt::values + 4 * i, static_cast<float>(state.x[i]));
  }
  store_le(all, kRaw2.answered, state.answered);
  store_le(all, Raw2Reading::buttons, state.buttons);
  bytes[Raw2Reading::no_force] = static_cast<std::uint8_t>(state.no_force);
  store_float_le(all, Raw2Reading::warmth, state.warmth);
  for (std::size_t i = 0; i < state.orientation.size(); ++i) {
    store_float_le(all, Raw2Reading::orientation + 4 * i, state.orientation[i]);
  }
  seal_raw_bytes(all);
  return bytes;
}

std::optional<RawOrder> raw_order(std::span<const std::uint8_t> packet, std::size_t joints,
                                  std::uint32_t last) {
  if (!raw_undamaged(packet, kRaw2.version, kRaw2.command) || packet[RawAt::joints] != joints) {
    return std::nullopt;
  }
  RawOrder order;
  order.sequence = load_le<std::uint32_t>(packet, RawAt::sequence);
  const std::uint8_t mode = packet[RawAt::flags];
  if (mode > static_cast<std::uint8_t>(RawMode::torque)) return std::nullopt;
  order.mode = static_cast<RawMode>(mode);
  if (order.mode == RawMode::no_torque) return order;
  if (static_cast<std::int32_t>(order.sequence - last) <= 0) return std::nullopt;
  for (std::size_t i = 0; i < joints; ++i) {
    order.torque[i] = static_cast<double>(load_float_le(packet, RawAt::values + 4 * i));
    if (!std::isfinite(order.torque[i])) return std::nullopt;
  }
  return order;
}

}  // namespace limpid
