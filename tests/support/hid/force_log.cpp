#include "tests/support/hid/force_log.h"

#include <algorithm>
#include <cmath>

namespace limpid::test {

namespace {

double size_of(const Torque& torque) {
  double largest = 0;
  for (const double one : torque) largest = std::max(largest, std::abs(one));
  return largest;
}

}  // namespace

std::optional<Time> ForceLog::zero_after(Time failure) const {
  if (size_of(newest()) > 0) return std::nullopt;
  Time zero = failure;
  for (auto sample = samples_.rbegin(); sample != samples_.rend(); ++sample) {
    if (size_of(sample->torque) > 0) break;
    zero = sample->time;
  }
  return std::max(zero - failure, Time::zero());
}

double ForceLog::largest(Time from) const {
  double largest = 0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const bool over = i + 1 < samples_.size() && samples_[i + 1].time <= from;
    if (!over) largest = std::max(largest, size_of(samples_[i].torque));
  }
  return largest;
}

Time ForceLog::longest_silence(Time from, Time to) const {
  Time before = from, longest{};
  for (const ForceSample& sample : samples_) {
    if (sample.cause != ForceCause::told || sample.time < from || sample.time > to) continue;
    longest = std::max(longest, sample.time - before);
    before = sample.time;
  }
  return std::max(longest, to - before);
}

}  // namespace limpid::test
