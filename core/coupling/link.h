// A delay between device and proxy, as in teleoperation: each side tells the other once a tick how
// it stands, in packets that come late, not equally late, or not at all.
//
// Each side goes by the packet that was sent last of all that have arrived; one that was overtaken
// is worth nothing any more. So what a side knows of the other is never older than delay + jitter,
// unless packets are lost.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/coupling/decomposition.h"
#include "core/coupling/laws.h"

namespace limpid {

// The numbers of a vector or matrix, as they lie in memory.
template <class M>
auto numbers(M& m) {
  return std::span(m.data(), static_cast<std::size_t>(m.size()));
}

// What the device's side knows at t_k.
template <int N>
struct FromDevice {
  Vec<N> x1, v1;       // as measured, (x1_k - x1_k-1) / T [rad, rad/s]
  Dynamics<N> device;  // M1, C1, and the velocity's estimate
  Vec<N> f1_hat;       // human torque, as observed [N m]
  double sent = 0;     // energy for the proxy's side, all of it since the start [J]

  static FromDevice zero(Eigen::Index joints) {
    const Vec<N> v = Vec<N>::Zero(joints);
    const Mat<N> M = Mat<N>::Zero(joints, joints);
    return {v, v, {M, M, v}, v};
  }
  // All that it is made of, of a packet that is const or not.
  static auto parts(auto& p) {
    return std::array{numbers(p.x1),
                      numbers(p.v1),
                      numbers(p.device.M),
                      numbers(p.device.C),
                      numbers(p.device.v),
                      numbers(p.f1_hat),
                      std::span(&p.sent, std::size_t{1})};
  }
  void come_to_rest() {
    v1.setZero();
    device.C.setZero();  // linear in the velocity
    device.v.setZero();
  }
};

// What the proxy's side knows once it has stepped.
template <int N>
struct FromProxy {
  Vec<N> x2, vbar2;   // at t_k, and its mean velocity over the tick before [rad, rad/s]
  Dynamics<N> proxy;  // M2, C2, v2 at t_k
  Vec<N> f2;          // contacts over the tick that begins [N m]
  double sent = 0;    // energy for the device's side, all of it since the start [J]

  static FromProxy zero(Eigen::Index joints) {
    const Vec<N> v = Vec<N>::Zero(joints);
    const Mat<N> M = Mat<N>::Zero(joints, joints);
    return {v, v, {M, M, v}, v};
  }
  // As FromDevice::parts().
  static auto parts(auto& p) {
    return std::array{numbers(p.x2),
                      numbers(p.vbar2),
                      numbers(p.proxy.M),
                      numbers(p.proxy.C),
                      numbers(p.proxy.v),
                      numbers(p.f2),
                      std::span(&p.sent, std::size_t{1})};
  }
  void come_to_rest() {
    vbar2.setZero();
    proxy.C.setZero();
    proxy.v.setZero();
  }
};

// What happens to a packet of one direction, the same for a seed everywhere: a function of the
// packet's number and of nothing else, so that a run that begins anew meets the same.
struct Fate {
  bool lost;
  int late;  // beyond the delay [ticks]
};
inline Fate fate_of(const LinkSettings& s, std::uint64_t direction, std::uint64_t packet) {
  // SplitMix64's output function (Steele, Lea, Flood 2014), over and over.
  const auto mixed = [](std::uint64_t z) {
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  };
  const std::uint64_t first =
      mixed(mixed(mixed(static_cast<std::uint64_t>(s.link_seed)) + direction) + packet);
  const std::uint64_t second = mixed(first);
  constexpr double kUnit = 0x1p-53;
  const auto choices = static_cast<std::uint64_t>(s.link_jitter) + 1;
  return {static_cast<double>(first >> 11) * kUnit < s.link_loss,
          static_cast<int>(((second >> 32) * choices) >> 32)};
}

// One direction. Storage for all that can be on its way is set aside beforehand, as large as the
// arm needs it, and written, so that no tick is the first to touch a page of it.
template <class Packet>
class OneWay {
 public:
  // `first`: of the sizes that all packets have.
  OneWay(std::uint64_t direction, const Packet& first)
      : direction_(direction), size_(size_of(first)), packets_(kSlots * size_), known_(first) {}

  // What is set aside for packets.
  std::span<const double> storage() const { return packets_; }

  // Nothing is on its way, and packets are counted anew.
  void start() {
    forget();
    tick_ = 0;
  }
  // Nothing is on its way: what is sent next counts as known to the other side, at rest.
  void forget() { fresh_ = true; }

  // Sends what is so now, and returns what the other side goes by in this tick.
  const Packet& pass(const Packet& now, const LinkSettings& s) {
    if (fresh_) {
      known_ = now;
      known_.come_to_rest();
      next_ = tick_;
      fresh_ = false;
    }
    const Fate fate = fate_of(s, direction_, tick_);
    store(now, tick_ % kSlots);
    arrives_[tick_ % kSlots] =
        fate.lost ? kNever : tick_ + static_cast<std::uint64_t>(s.link_delay + fate.late);
    const std::uint64_t oldest = tick_ >= kSlots ? tick_ - (kSlots - 1) : 0;
    for (std::uint64_t i = tick_ + 1; i-- > std::max(next_, oldest);) {
      if (arrives_[i % kSlots] > tick_) continue;
      load(i % kSlots, known_);
      next_ = i + 1;
      break;
    }
    ++tick_;
    return known_;
  }

 private:
  static constexpr std::uint64_t kSlots = 256;
  static_assert(kSlots > kMostLinkDelay + kMostLinkJitter);
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  static std::size_t size_of(const Packet& packet) {
    std::size_t size = 0;
    for (const auto part : Packet::parts(packet)) size += part.size();
    return size;
  }
  void store(const Packet& packet, std::size_t slot) {
    double* to = packets_.data() + slot * size_;
    for (const auto part : Packet::parts(packet)) to = std::copy(part.begin(), part.end(), to);
  }
  void load(std::size_t slot, Packet& packet) const {
    const double* from = packets_.data() + slot * size_;
    for (const auto part : Packet::parts(packet)) {
      std::copy_n(from, part.size(), part.begin());
      from += part.size();
    }
  }

  std::uint64_t direction_;
  std::size_t size_;             // of a packet, in numbers
  std::vector<double> packets_;  // by their number, the tick in which they were sent
  std::array<std::uint64_t, kSlots> arrives_{};
  Packet known_;            // to the other side
  std::uint64_t next_ = 0;  // the first number that is newer than it
  std::uint64_t tick_ = 0;
  bool fresh_ = true;
};

template <int N>
class ProxyLink {
 public:
  explicit ProxyLink(Eigen::Index joints)
      : to_proxy_(1, FromDevice<N>::zero(joints)), to_device_(2, FromProxy<N>::zero(joints)) {}

  // Both sides know how the other one now stands, at rest; nothing is on its way.
  void start() {
    to_proxy_.start();
    to_device_.start();
  }
  // As it is set, for the tick that begins; null where there is none, and both know all at once.
  ProxyLink* of(const LinkSettings& s) {
    s_ = s;
    if (s.linked()) return this;
    to_proxy_.forget();
    to_device_.forget();
    return nullptr;
  }
  // Once a tick each: what the other side goes by in it.
  const FromDevice<N>& to_proxy(const FromDevice<N>& now) { return to_proxy_.pass(now, s_); }
  const FromProxy<N>& to_device(const FromProxy<N>& now) { return to_device_.pass(now, s_); }

 private:
  LinkSettings s_;
  OneWay<FromDevice<N>> to_proxy_;
  OneWay<FromProxy<N>> to_device_;
};

}  // namespace limpid
