// The past of every plotted quantity: the newest minute of a running loop or a whole recording.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/base/large_memory.h"

namespace limpid {

// Smallest and largest of some values.
struct Extent {
  float low = std::numeric_limits<float>::infinity();
  float high = -std::numeric_limits<float>::infinity();

  bool empty() const { return low > high; }

  // Leaves out a value that is not a number, by the order of the comparisons.
  void include(float value) {
    low = value < low ? value : low;
    high = value > high ? value : high;
  }
  void include(const Extent& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }

  friend bool operator==(const Extent&, const Extent&) = default;
};

// Number of a sample: from 0 in the order of arrival; stays when older samples are overwritten.
using SampleIndex = std::uint64_t;

// The newest samples of one channel, with the extents of ever larger blocks of them.
//
// Blocks of 8, 64, 512 and 4096 samples are summed up as soon as they are full. So the extent of
// any stretch costs a few dozen comparisons however long it is. A channel that has never had a
// number is only counted: those of a further run that does not exist.
class MinMaxRing {
 public:
  static constexpr int kFanBits = 3;
  static constexpr std::size_t kFan = std::size_t{1} << kFanBits;
  static constexpr int kLevels = 4;  // above the samples themselves
  static constexpr std::size_t kLargestBlock = std::size_t{1} << (kFanBits * kLevels);

  // `at_least`: number of samples to keep; rounded up to whole largest blocks.
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

  // Returns the exact extent of the samples [from, to) inside [first(), end()), without those that
  // are not numbers.
  Extent extent(SampleIndex from, SampleIndex to) const;

 private:
  // Returns the place of block `index` of a level. The ring holds at most two laps, the newest of
  // which began at sample lap_: cheaper than a division.
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
  // Storage is reserved with the first number, and touched only as samples come.
  LargeVector<float> samples_;
  std::array<LargeVector<Extent>, kLevels> blocks_;
  SampleIndex end_ = 0;
  SampleIndex lap_ = 0;
};

// A moment worth remembering, such as a change of a setting.
struct PlotMark {
  double time;  // on the history's time axis [s]
  std::string key;
  std::string label;
};

// Keys of marks: where a new run or a recording begins, and those that people set.
inline constexpr const char* kResetMark = "reset";
inline constexpr const char* kRecordingMark = "rec";
inline constexpr const char* kNoteMark = "note";

// Rows of `channels` values in time order. The time axis only ever grows. Where the time handed to
// append() steps back (a reset), the axis goes on after a short gap and offset() tells the
// difference. So data before and after a reset can be looked at together.
//
// Memory is set aside once for a channel, with its first number: about 5.2 bytes a value. It is
// used as rows come.
class History {
 public:
  static constexpr std::size_t kMostMarks = 500;

  struct Options {
    int channels = 1;
    double seconds = 60;  // least time to keep [s]
    double tick = 0.001;  // time between rows [s]; more than 1.5 of it is a gap
  };

  // Throws std::invalid_argument when an option is not positive.
  explicit History(const Options& options);

  // Appends a row. `time` [s] as the loop counts it; `values`: one for each channel, in its own
  // unit; values that are not finite are shown as gaps of their channel. Throws
  // std::invalid_argument for a wrong number of values or a time that is not finite.
  void append(double time, std::span<const double> values);

  // Adds a mark at `time` [s] as the loop counts it. Replaces a mark with the same key less than
  // half a second ago, so that dragging a slider leaves one mark. Drops the oldest beyond
  // kMostMarks, as each is drawn in every frame.
  void mark(double time, std::string label, std::string key = "");
  // Adds a mark at a time of the history's axis, which may be long ago.
  void mark_at(double axis_time, std::string label, std::string key);
  // Replaces all marks with the key by `marks` [s on the axis].
  void replace_marks(const std::string& key, const std::vector<PlotMark>& marks);

  void clear();

  int channels() const { return static_cast<int>(rings_.size()); }
  double tick() const { return tick_; }
  bool empty() const { return end() == 0; }
  SampleIndex first() const { return rings_.front().first(); }
  SampleIndex end() const { return rings_.front().end(); }

  // Times on the history's axis [s]; the axis minus offset() is the time of the newest run.
  double start_time() const { return empty() ? 0 : time(first()); }
  double end_time() const { return empty() ? 0 : time(end() - 1); }
  double offset() const { return offset_; }
  // Returns the beginning of the newest run.
  double run_start() const { return std::max(run_start_, start_time()); }
  double time(SampleIndex index) const;
  float value(int channel, SampleIndex index) const { return ring(channel).at(index); }

  // Returns whether rows are missing between this one and the one before.
  bool gap_before(SampleIndex index) const;

  // Returns the first row at `time` or later; end() when there is none. `from`: a row known to lie
  // before, which makes walking along the axis cheap.
  SampleIndex lower_bound(double time) const;
  SampleIndex lower_bound(double time, SampleIndex from) const;

  // Returns the row closest to `time`; the history must not be empty.
  SampleIndex nearest(double time) const;

  // Returns the exact extent of a channel over rows [from, to), or over the times [start, stop].
  Extent extent(int channel, SampleIndex from, SampleIndex to) const {
    return ring(channel).extent(from, to);
  }
  Extent extent_between(int channel, double start, double stop) const;

  const std::deque<PlotMark>& marks() const { return marks_; }

 private:
  const MinMaxRing& ring(int channel) const { return rings_[static_cast<std::size_t>(channel)]; }
  void forget_old_marks();

  double tick_;
  double offset_ = 0;
  double run_start_ = 0;
  std::vector<MinMaxRing> rings_;
  LargeVector<double> times_;
  std::deque<PlotMark> marks_;
};

}  // namespace limpid
