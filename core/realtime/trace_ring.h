// Queues from one thread to another that keep order and never wait. TraceRing carries the rows of
// the trace, SpscQueue events. A full queue refuses new entries; it never overwrites older ones.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

namespace limpid {

// Positions of one producer and one consumer in a ring of `capacity` places.
//
// Both positions only grow; a place is its position modulo the capacity. Memory ordering: the
// producer fills places and then stores its position with release. The consumer loads it with
// acquire before reading them, so it sees them filled. In turn the consumer's release and the
// producer's acquire keep a place from being filled again before it has been read.
class RingPositions {
 public:
  // capacity: a power of two, else std::invalid_argument.
  explicit RingPositions(std::size_t capacity) : capacity_(capacity) {
    if (!std::has_single_bit(capacity))
      throw std::invalid_argument("a ring's capacity must be a power of two");
  }

  std::size_t capacity() const noexcept { return capacity_; }

  // Number of filled places; to a third thread, the number a moment ago.
  std::size_t size() const noexcept {
    const std::size_t popped = popped_.load(std::memory_order_acquire);
    const std::size_t pushed = pushed_.load(std::memory_order_acquire);
    return std::min(pushed - popped, capacity_);
  }

  // Producer: the place to fill next (if size() < capacity()), and that it has been filled.
  std::size_t back() const noexcept {
    return pushed_.load(std::memory_order_relaxed) & (capacity_ - 1);
  }
  void push() noexcept {
    pushed_.store(pushed_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  // Consumer: the oldest filled place (if size() > 0), and that `count` places have been read.
  std::size_t front() const noexcept {
    return popped_.load(std::memory_order_relaxed) & (capacity_ - 1);
  }
  void pop(std::size_t count) noexcept {
    popped_.store(popped_.load(std::memory_order_relaxed) + count, std::memory_order_release);
  }

 private:
  std::size_t capacity_;
  // Each on a cache line of its own: the two threads do not slow each other down.
  alignas(64) std::atomic<std::size_t> pushed_{0};
  alignas(64) std::atomic<std::size_t> popped_{0};
};

// A queue of events. T: default constructible, copied without allocating.
template <class T>
class SpscQueue {
 public:
  explicit SpscQueue(std::size_t capacity) : at_(capacity), places_(capacity) {}

  std::size_t size() const noexcept { return at_.size(); }
  std::size_t capacity() const noexcept { return at_.capacity(); }

  // Producer: false when the queue is full; `value` was then not taken.
  bool push(const T& value) noexcept {
    if (at_.size() == at_.capacity()) return false;
    places_[at_.back()] = value;
    at_.push();
    return true;
  }

  // Consumer: the oldest value, if there is one.
  std::optional<T> pop() noexcept {
    if (at_.size() == 0) return std::nullopt;
    const std::optional<T> value = places_[at_.front()];
    at_.pop(1);
    return value;
  }

 private:
  RingPositions at_;
  std::vector<T> places_;
};

// Rows of `stride` doubles, numbered from 0 in the order in which they were offered: a row that was
// refused leaves a gap in the numbers.
class TraceRing {
 public:
  // capacity: in rows, a power of two; stride: at least 1; else std::invalid_argument.
  TraceRing(std::size_t capacity, std::size_t stride)
      : at_(capacity), stride_(stride), rows_(capacity * stride), numbers_(capacity) {
    if (stride == 0) throw std::invalid_argument("a trace ring's rows need at least one column");
  }

  std::size_t size() const noexcept { return at_.size(); }          // rows
  std::size_t capacity() const noexcept { return at_.capacity(); }  // rows
  std::size_t stride() const noexcept { return stride_; }           // doubles a row

  // Rows refused for want of room since the beginning; for any thread.
  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

  // Producer: false when the ring is full; the row is then dropped and counted.
  // row: exactly stride() doubles.
  bool push(std::span<const double> row) noexcept {
    assert(row.size() == stride_);
    const std::uint64_t number = offered_++;
    if (at_.size() == at_.capacity()) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    std::ranges::copy(row, place(at_.back()));
    numbers_[at_.back()] = number;
    at_.push();
    return true;
  }

  // Consumer: the number of the oldest row (if size() > 0).
  std::uint64_t number() const noexcept { return numbers_[at_.front()]; }

  // Consumer: moves the oldest rows, as many whole ones as fit and as have consecutive numbers, to
  // the beginning of `into`; returns how many.
  std::size_t pop(std::span<double> into) noexcept {
    const std::size_t count = consecutive(std::min(at_.size(), into.size() / stride_));
    const std::size_t before_the_seam = std::min(count, at_.capacity() - at_.front());
    const auto rest = std::copy_n(place(at_.front()), before_the_seam * stride_, into.begin());
    std::copy_n(place(0), (count - before_the_seam) * stride_, rest);
    at_.pop(count);
    return count;
  }

 private:
  // Number of rows before a gap, of the `most` oldest.
  std::size_t consecutive(std::size_t most) const noexcept {
    std::size_t count = std::min<std::size_t>(most, 1);
    while (count < most &&
           numbers_[(at_.front() + count) & (at_.capacity() - 1)] == number() + count) {
      ++count;
    }
    return count;
  }
  double* place(std::size_t index) noexcept { return rows_.data() + index * stride_; }

  RingPositions at_;
  std::size_t stride_;
  std::vector<double> rows_;
  std::vector<std::uint64_t> numbers_;
  std::uint64_t offered_ = 0;  // the producer's
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace limpid
