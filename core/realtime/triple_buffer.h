// The newest value from one thread to another; neither ever waits.
//
// Three slots: one belongs to the writer (back), one to the reader (front), and the third (middle)
// is where they swap. Values that nobody collected are overwritten by newer ones.
//
// Memory ordering: one atomic byte says which slot is the middle one and whether it is new; both
// sides change it by an exchange with acquire-release. Release: the writer's stores into a slot
// come before its hand-over, and the reader's last reads before its return. Acquire: whoever
// receives a slot sees all that the other side did to it before. A slot has one owner at any time,
// so the values themselves need no atomics and cannot be torn.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace limpid {

// T: copied without allocating. One thread calls the writer's functions, one the reader's.
template <class T>
class TripleBuffer {
 public:
  explicit TripleBuffer(const T& initial = T{}) : slots_{{{initial}, {initial}, {initial}}} {}

  TripleBuffer(const TripleBuffer&) = delete;
  TripleBuffer& operator=(const TripleBuffer&) = delete;

  // Writer: the slot to fill. Fill all of it: it holds some older value.
  T& back() noexcept { return slots_[back_].value; }

  // Writer: hands the back slot over.
  void publish() noexcept {
    const auto handed_over = static_cast<std::uint8_t>(back_ | kFresh);
    back_ = middle_.exchange(handed_over, std::memory_order_acq_rel) & kIndex;
  }

  // Writer: fills and publishes in one call.
  void write(const T& value) noexcept {
    back() = value;
    publish();
  }

  // Reader: brings the newest value to the front; false if nothing new was published.
  bool update() noexcept {
    if (!(middle_.load(std::memory_order_relaxed) & kFresh)) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }

  // Reader: the value of the last update(), the initial one before the first.
  const T& front() const noexcept { return slots_[front_].value; }

 private:
  static constexpr std::uint8_t kIndex = 0b011;
  static constexpr std::uint8_t kFresh = 0b100;

  // Each slot has cache lines of its own: the two threads do not slow each other down.
  struct alignas(64) Slot {
    T value;
  };
  std::array<Slot, 3> slots_;
  alignas(64) std::uint8_t back_ = 0;
  alignas(64) std::atomic<std::uint8_t> middle_{1};
  alignas(64) std::uint8_t front_ = 2;
};

}  // namespace limpid
