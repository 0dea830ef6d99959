// The newest samples of one channel with the extents of ever larger blocks of them kept beside.
//
// Blocks of 8, 64, 512 and 4096 samples are summed up as soon as they are full, so that the extent
// of any stretch costs a few dozen comparisons however long it is. Samples are numbered from 0 in
// the order of arrival; a sample keeps its number when older ones are overwritten. A channel that
// has never had a number, as those of a second run that there is not, is only counted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "app/plot/extent.h"

namespace limpid {

using SampleIndex = std::uint64_t;

class MinMaxRing {
 public:
  static constexpr int kFanBits = 3;
  static constexpr std::size_t kFan = std::size_t{1} << kFanBits;
  static constexpr int kLevels = 4;  // above the samples themselves
  static constexpr std::size_t kLargestBlock = std::size_t{1} << (kFanBits * kLevels);

  // `at_least`: how many samples to keep; rounded up to whole largest blocks.
  explicit MinMaxRing(std::size_t at_least);

  void append(float sample);
  void clear() { end_ = lap_ = 0; }

  std::size_t capacity() const { return capacity_; }
  SampleIndex first() const { return end_ > capacity() ? end_ - capacity() : 0; }
  SampleIndex end() const { return end_; }

  // `index` from first() to end() - 1.
  float at(SampleIndex index) const {
    return samples_.empty() ? kNothing : samples_[slot(index, 0)];
  }

  // Exact extent of the samples [from, to) inside [first(), end()); not-a-numbers do not count.
  Extent extent(SampleIndex from, SampleIndex to) const;

 private:
  // Where block `index` of a level lies. The ring holds at most two laps, the newest of which began
  // at sample lap_: cheaper than a division.
  std::size_t slot(SampleIndex index, int level) const {
    const SampleIndex lap = lap_ >> (kFanBits * level);
    const std::size_t size = capacity() >> (kFanBits * level);
    return static_cast<std::size_t>(index >= lap ? index - lap : index + size - lap);
  }
  void include(Extent& extent, SampleIndex index, int level) const;
  void keep(float sample);
  void make_up();

  static constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

  std::size_t capacity_;
  // Their memory is taken at once, and touched only as samples come.
  std::vector<float> samples_;
  std::array<std::vector<Extent>, kLevels> blocks_;
  SampleIndex end_ = 0;
  SampleIndex lap_ = 0;
};

}  // namespace limpid
