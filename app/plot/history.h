// The past of every plotted quantity: the newest minute of a running loop or a whole recording.
#pragma once

#include <algorithm>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "app/plot/extent.h"
#include "app/plot/min_max_ring.h"

namespace limpid {

// A moment worth remembering, such as a change of a setting.
struct Mark {
  double time;  // on the history's time axis [s]
  std::string key;
  std::string label;
};

inline constexpr const char* kResetMark = "reset";  // key of the mark where a new run begins

// Rows of `channels` values in time order. The time axis only ever grows: where the time handed to
// append() steps back (a reset), the axis goes on after a short gap and offset() tells the
// difference, so that data before and after a reset can be looked at together.
//
// Memory is set aside once, by the constructor: about 5.2 bytes a value and 8 bytes a row; it is
// used as rows come.
class History {
 public:
  struct Options {
    int channels = 1;
    double seconds = 60;  // how much to keep at least [s]
    double tick = 0.001;  // time between rows [s]; more than 1.5 of it is a gap
  };

  // Throws std::invalid_argument when an option is not positive.
  explicit History(const Options& options);

  // `time` [s] as the loop counts it; `values`: one for each channel, in its own unit; values that
  // are not finite are shown as gaps of their channel. Throws std::invalid_argument for a wrong
  // number of values or a time that is not finite.
  void append(double time, std::span<const double> values);

  // `time` [s] as the loop counts it. A mark with the same key less than half a second ago is
  // replaced, so that dragging a slider leaves one mark.
  void mark(double time, std::string label, std::string key = "");

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
  // Where the newest run begins.
  double run_start() const { return std::max(run_start_, start_time()); }
  double time(SampleIndex index) const;
  float value(int channel, SampleIndex index) const { return ring(channel).at(index); }

  // Whether rows are missing between this one and the one before.
  bool gap_before(SampleIndex index) const;

  // First row at `time` or later; end() when there is none. `from`: a row known to lie before,
  // which makes walking along the axis cheap.
  SampleIndex lower_bound(double time) const;
  SampleIndex lower_bound(double time, SampleIndex from) const;

  // Row closest to `time`; the history must not be empty.
  SampleIndex nearest(double time) const;

  // Exact extent of a channel over rows [from, to), or over the times [start, stop].
  Extent extent(int channel, SampleIndex from, SampleIndex to) const {
    return ring(channel).extent(from, to);
  }
  Extent extent_between(int channel, double start, double stop) const;

  const std::deque<Mark>& marks() const { return marks_; }

 private:
  const MinMaxRing& ring(int channel) const { return rings_[static_cast<std::size_t>(channel)]; }
  void forget_old_marks();

  double tick_;
  double offset_ = 0;
  double run_start_ = 0;
  std::vector<MinMaxRing> rings_;
  std::vector<double> times_;
  std::deque<Mark> marks_;
};

}  // namespace limpid
