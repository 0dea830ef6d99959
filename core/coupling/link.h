// A delayed link between device and proxy, as in teleoperation: each side sends its state once a
// tick, in packets that come late, with jitter, or not at all.
//
// Each side uses, of all packets that have arrived, the one sent last; overtaken packets are
// dropped. So its knowledge of the other is never older than delay + jitter, unless packets are
// lost.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/coupling/decomposition.h"
#include "core/coupling/spring_damper.h"
#include "core/math/elementary.h"

namespace limpid {

// Numbers of a vector or matrix, in the order of memory.
template <class M>
auto numbers(M& m) {
  return std::span(m.data(), static_cast<std::size_t>(m.size()));
}

// State of the device's side at t_k.
template <int N>
struct FromDevice {
  Vec<N> x1, v1;       // measured position, (x1_k - x1_k-1) / T [rad, rad/s]
  Dynamics<N> device;  // M1, C1, and the estimated velocity
  Vec<N> f1_hat;       // human torque, as observed [N m]
  double sent = 0;     // energy sent to the proxy's side, in all since the start [J]
  double number = 0;   // ticks since the start
  Vec<N> waves;        // sum of the waves sent, see wave.h [sqrt(W) s]

  static FromDevice zero(Eigen::Index joints) {
    const Vec<N> v = Vec<N>::Zero(joints);
    const Mat<N> M = Mat<N>::Zero(joints, joints);
    return {v, v, {M, M, v}, v, 0, 0, v};
  }
  // All parts of a packet, const or not.
  static auto parts(auto& p) {
    return std::array{numbers(p.x1),
                      numbers(p.v1),
                      numbers(p.device.M),
                      numbers(p.device.C),
                      numbers(p.device.v),
                      numbers(p.f1_hat),
                      std::span(&p.sent, std::size_t{1}),
                      std::span(&p.number, std::size_t{1}),
                      numbers(p.waves)};
  }
  void come_to_rest() {
    v1.setZero();
    device.C.setZero();  // linear in the velocity
    device.v.setZero();
  }
};

// State of the proxy's side after its step.
template <int N>
struct FromProxy {
  Vec<N> x2, vbar2;   // position at t_k, mean velocity over the previous tick [rad, rad/s]
  Dynamics<N> proxy;  // M2, C2, v2 at t_k
  Vec<N> f2;          // of the contacts over the tick that begins [N m]
  double sent = 0;    // energy sent to the device's side, in all since the start [J]
  double number = 0;  // ticks since the start
  Vec<N> waves;       // see FromDevice

  static FromProxy zero(Eigen::Index joints) {
    const Vec<N> v = Vec<N>::Zero(joints);
    const Mat<N> M = Mat<N>::Zero(joints, joints);
    return {v, v, {M, M, v}, v, 0, 0, v};
  }
  // All parts of a packet, see FromDevice::parts().
  static auto parts(auto& p) {
    return std::array{numbers(p.x2),
                      numbers(p.vbar2),
                      numbers(p.proxy.M),
                      numbers(p.proxy.C),
                      numbers(p.proxy.v),
                      numbers(p.f2),
                      std::span(&p.sent, std::size_t{1}),
                      std::span(&p.number, std::size_t{1}),
                      numbers(p.waves)};
  }
  void come_to_rest() {
    vbar2.setZero();
    proxy.C.setZero();
    proxy.v.setZero();
  }
};

// Fate of a packet of one direction, a function of seed, direction and number alone, so that a run
// that begins anew meets the same.
struct Fate {
  bool lost;
  int late;  // lateness beyond the delay [ticks]
};
inline Fate fate_of(const LinkSettings& s, std::uint64_t direction, std::uint64_t packet) {
  // SplitMix64's output function (Steele, Lea, Flood 2014), applied repeatedly.
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

// A direction of the link. Storage for all packets on their way is allocated and written
// beforehand, so that no tick is the first to touch a page of it.
template <class Packet>
class OneWay {
 public:
  // `first`: has the sizes of all packets.
  OneWay(std::uint64_t direction, const Packet& first)
      : direction_(direction), size_(size_of(first)), packets_(kSlots * size_), known_(first) {}

  // Storage of the packets.
  std::span<const double> storage() const { return packets_; }

  // Empties the link and counts packets anew.
  void start() {
    forget();
    tick_ = 0;
  }
  // Empties the link: the other side knows the next packet at once, with the sender at rest.
  void forget() { fresh_ = true; }

  // Sends `now`, and returns the packet that the other side uses in this tick.
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
  std::size_t size_;             // numbers in a packet
  std::vector<double> packets_;  // by packet number, which is the tick of sending
  std::array<std::uint64_t, kSlots> arrives_{};
  Packet known_;            // packet known to the other side
  std::uint64_t next_ = 0;  // first number newer than known_
  std::uint64_t tick_ = 0;
  bool fresh_ = true;
};

template <int N>
class ProxyLink {
 public:
  explicit ProxyLink(Eigen::Index joints)
      : to_proxy_(1, FromDevice<N>::zero(joints)), to_device_(2, FromProxy<N>::zero(joints)) {}

  // Begins: each side knows the other's present position, at rest; nothing is on its way.
  void start() {
    to_proxy_.start();
    to_device_.start();
  }
  // Returns the link as set for the tick that begins; null without a link: both sides know all at
  // once.
  ProxyLink* of(const LinkSettings& s) {
    s_ = s;
    if (s.linked()) return this;
    to_proxy_.forget();
    to_device_.forget();
    return nullptr;
  }
  // Delay after which waves are played out, see PlayedWaves [ticks].
  double wave_delay() const {
    const double spare =
        s_.link_loss > 0 ? std::ceil(logarithm(1e-6) / logarithm(s_.link_loss)) : 0;
    return s_.oldest() + spare;
  }
  // Each once a tick: the packet that the other side uses in it.
  const FromDevice<N>& to_proxy(const FromDevice<N>& now) { return to_proxy_.pass(now, s_); }
  const FromProxy<N>& to_device(const FromProxy<N>& now) { return to_device_.pass(now, s_); }

 private:
  LinkSettings s_;
  OneWay<FromDevice<N>> to_proxy_;
  OneWay<FromProxy<N>> to_device_;
};

}  // namespace limpid
