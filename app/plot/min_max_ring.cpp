#include "app/plot/min_max_ring.h"

#include <cmath>

namespace limpid {
namespace {

template <class T>
void put(std::vector<T>& ring, std::size_t at, const T& value) {
  if (at < ring.size()) {
    ring[at] = value;
  } else {
    ring.push_back(value);
  }
}

}  // namespace

MinMaxRing::MinMaxRing(std::size_t at_least) {
  const std::size_t blocks =
      std::max<std::size_t>((at_least + kLargestBlock - 1) / kLargestBlock, 1);
  capacity_ = blocks * kLargestBlock;
  samples_.reserve(capacity_);
  for (int level = 1; level <= kLevels; ++level) {
    blocks_[static_cast<std::size_t>(level - 1)].reserve(capacity() >> (kFanBits * level));
  }
}

void MinMaxRing::append(float sample) {
  if (samples_.empty() && !std::isnan(sample)) make_up();
  if (!samples_.empty() || !std::isnan(sample)) keep(sample);
  ++end_;
  if (end_ - lap_ == capacity()) lap_ = end_;
}

// What was only counted, before the first number.
void MinMaxRing::make_up() {
  const std::size_t rows = end_ < capacity() ? static_cast<std::size_t>(end_) : capacity();
  samples_.assign(rows, kNothing);
  for (std::size_t level = 0; level < kLevels; ++level) {
    blocks_[level].assign(rows >> (kFanBits * (level + 1)), Extent{});
  }
}

void MinMaxRing::keep(float sample) {
  std::size_t at = static_cast<std::size_t>(end_ - lap_);
  put(samples_, at, sample);
  for (std::size_t level = 0; level < kLevels && at % kFan == kFan - 1; ++level) {
    const std::size_t child = at - (kFan - 1);
    Extent extent;
    for (std::size_t i = child; i <= at; ++i) {
      if (level == 0) {
        extent.include(samples_[i]);
      } else {
        extent.include(blocks_[level - 1][i]);
      }
    }
    at /= kFan;
    put(blocks_[level], at, extent);
  }
}

void MinMaxRing::include(Extent& extent, SampleIndex index, int level) const {
  if (level == 0) {
    extent.include(samples_[slot(index, 0)]);
  } else {
    extent.include(blocks_[static_cast<std::size_t>(level - 1)][slot(index, level)]);
  }
}

Extent MinMaxRing::extent(SampleIndex from, SampleIndex to) const {
  Extent extent;
  if (samples_.empty()) return extent;
  for (int level = 0;; ++level) {
    if (level == kLevels || to - from < 2 * kFan) {
      while (from < to) include(extent, from++, level);
      return extent;
    }
    while (from % kFan != 0) include(extent, from++, level);
    while (to % kFan != 0) include(extent, --to, level);
    from /= kFan;
    to /= kFan;
  }
}

}  // namespace limpid
