#include "app/plot/history.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace limpid {

namespace {

template <class T>
void put(LargeVector<T>& ring, std::size_t at, const T& value) {
  if (at < ring.size()) {
    ring[at] = value;
  } else {
    ring.push_back(value);
  }
}

constexpr double kGapTicks = 1.5;
constexpr double kResetGap = 0.2;     // shown between two runs [s]
constexpr double kSameGesture = 0.5;  // marks of one key closer than this are one [s]
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

}  // namespace

MinMaxRing::MinMaxRing(std::size_t at_least) {
  const std::size_t blocks =
      std::max<std::size_t>((at_least + kLargestBlock - 1) / kLargestBlock, 1);
  capacity_ = blocks * kLargestBlock;
}

void MinMaxRing::append(float sample) {
  if (samples_.empty() && !std::isnan(sample)) make_up();
  if (!samples_.empty() || !std::isnan(sample)) keep(sample);
  ++end_;
  if (end_ - lap_ == capacity()) lap_ = end_;
}

// Stores the rows that were only counted as no numbers, before the first number comes.
void MinMaxRing::make_up() {
  const std::size_t rows = end_ < capacity() ? static_cast<std::size_t>(end_) : capacity();
  samples_.reserve(capacity());
  samples_.assign(rows, kNothing);
  for (std::size_t level = 0; level < kLevels; ++level) {
    blocks_[level].reserve(capacity() >> (kFanBits * (level + 1)));
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

History::History(const Options& options) : tick_(options.tick) {
  if (options.channels < 1 || !(options.seconds > 0) || !(options.tick > 0)) {
    throw std::invalid_argument("history: channels, seconds and tick must be positive");
  }
  const auto rows = static_cast<std::size_t>(std::ceil(options.seconds / options.tick)) + 1;
  for (int i = 0; i < options.channels; ++i) rings_.emplace_back(rows);
  times_.resize(rings_.front().capacity());
}

void History::append(double time, std::span<const double> values) {
  if (values.size() != rings_.size()) {
    throw std::invalid_argument("history: " + std::to_string(values.size()) + " values for " +
                                std::to_string(rings_.size()) + " channels");
  }
  if (!std::isfinite(time)) throw std::invalid_argument("history: time is not finite");
  if (!empty() && time + offset_ <= end_time()) {
    offset_ = end_time() + kResetGap - time;
    run_start_ = time + offset_;
    mark(time, "t = 0", kResetMark);
  }
  times_[static_cast<std::size_t>(end() % times_.size())] = time + offset_;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = static_cast<float>(values[i]);
    rings_[i].append(std::isfinite(value) ? value : kNothing);
  }
  forget_old_marks();
}

void History::mark(double time, std::string label, std::string key) {
  mark_at(time + offset_, std::move(label), std::move(key));
}

void History::mark_at(double at, std::string label, std::string key) {
  if (!key.empty() && key != kNoteMark && !marks_.empty() && marks_.back().key == key &&
      at - marks_.back().time < kSameGesture) {
    marks_.pop_back();
  }
  const auto place = std::ranges::upper_bound(marks_, at, {}, &PlotMark::time);
  marks_.insert(place, {at, std::move(key), std::move(label)});
  if (marks_.size() > kMostMarks) marks_.pop_front();
}

void History::replace_marks(const std::string& key, const std::vector<PlotMark>& marks) {
  std::erase_if(marks_, [&](const PlotMark& mark) { return mark.key == key; });
  for (const PlotMark& mark : marks) mark_at(mark.time, mark.label, mark.key);
}

void History::forget_old_marks() {
  while (!marks_.empty() && marks_.front().time < start_time()) marks_.pop_front();
}

void History::clear() {
  for (MinMaxRing& each : rings_) each.clear();
  marks_.clear();
  offset_ = run_start_ = 0;
}

double History::time(SampleIndex index) const {
  return times_[static_cast<std::size_t>(index % times_.size())];
}

bool History::gap_before(SampleIndex index) const {
  return index <= first() || time(index) - time(index - 1) > kGapTicks * tick_;
}

SampleIndex History::lower_bound(double time_wanted) const {
  return lower_bound(time_wanted, first());
}

SampleIndex History::lower_bound(double time_wanted, SampleIndex from) const {
  // The search gallops: the row is mostly close to `from`, and then a few steps are enough.
  SampleIndex low = from;
  SampleIndex high = from;
  for (SampleIndex step = 1; high < end() && time(high) < time_wanted; step *= 2) {
    low = high + 1;
    high = std::min(end(), high + step);
  }
  while (low < high) {
    const SampleIndex middle = low + (high - low) / 2;
    if (time(middle) < time_wanted) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

SampleIndex History::nearest(double time_wanted) const {
  const SampleIndex after = lower_bound(time_wanted);
  if (after == first()) return after;
  if (after == end()) return after - 1;
  return time(after) - time_wanted < time_wanted - time(after - 1) ? after : after - 1;
}

Extent History::extent_between(int channel, double start, double stop) const {
  const SampleIndex from = lower_bound(start);
  SampleIndex to = lower_bound(stop, from);
  if (to < end() && time(to) == stop) ++to;
  return extent(channel, from, to);
}

}  // namespace limpid
