#include "app/desktop/coupling/chatter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/plot/trace_channels.h"

namespace limpid {

void Chatter::start_over(SampleIndex next) {
  *this = Chatter();
  next_ = next;
}

void Chatter::follow(const History& history, SampleIndex end, int first,
                     const Eigen::VectorXd& springs) {
  const bool same = springs.size() == springs_.size() && springs == springs_;
  if (end < next_ || !same || history.first() > next_) {
    start_over(std::max(end < next_ ? SampleIndex{0} : next_, history.first()));
    springs_ = springs;
  }
  const auto size = static_cast<SampleIndex>(std::lround(kStretch / history.tick()));
  for (; end - next_ >= size; next_ += size) {
    const double took = history.time(next_ + size - 1) - history.time(next_);
    const Stretch now = measure(history, next_, next_ + size, first, springs);
    // The run began anew or stood still in between, or does not exist.
    if (took > 1.1 * kStretch || !std::isfinite(now.energy)) {
      before_.reset();
      in_a_row_ = 0;
      continue;
    }
    const double gain = before_ ? now.energy - before_->energy : 0;
    const double held = before_ ? now.held - before_->held : 0;
    power_ = std::min(gain, gain + held) / kStretch;
    frequency_ = now.frequency;
    in_a_row_ = power_ > kPower && frequency_ > kFrequency ? in_a_row_ + 1 : 0;
    before_ = now;
  }
}

Chatter::Stretch Chatter::measure(const History& history, SampleIndex from, SampleIndex to,
                                  int first, const Eigen::VectorXd& springs) {
  const auto at = [&](int channel, SampleIndex k) {
    return static_cast<double>(history.value(first + channel, k));
  };
  const auto of = [](Channel channel) { return static_cast<int>(channel); };
  const auto count = static_cast<double>(to - from);
  Stretch stretch{0, 0, 0};
  double widest = 0;
  for (Eigen::Index j = 0; j < springs.size(); ++j) {
    const int joint = of(Channel::joints) + static_cast<int>(j);
    double low = at(joint, from), high = low, sum = 0;
    for (SampleIndex k = from; k < to; ++k) {
      const double x = at(joint, k);
      low = std::min(low, x);
      high = std::max(high, x);
      sum += x;
      stretch.held += 0.5 * springs[j] * x * x / count;
    }
    if (high - low <= widest) continue;
    widest = high - low;
    // A crossing goes through the middle by at least a quarter of the whole way.
    int side = 0, crossings = 0;
    for (SampleIndex k = from; k < to; ++k) {
      const double x = at(joint, k) - sum / count;
      const int now = x > widest / 8 ? 1 : x < -widest / 8 ? -1 : side;
      if (side != 0 && now != side) ++crossings;
      side = now;
    }
    stretch.frequency = 0.5 * crossings / (count * history.tick());
  }
  for (SampleIndex k = from; k < to; ++k) {
    stretch.energy +=
        (at(of(Channel::energy_total), k) - at(of(Channel::energy_compensation), k)) / count;
  }
  return stretch;
}

bool PlayedChatter::there(const History& history, SampleIndex at, int first,
                          const Eigen::VectorXd& springs) {
  const auto enough = static_cast<SampleIndex>(std::lround(2 / history.tick()));
  const SampleIndex end = at + 1;
  if (end < seen_ || end > seen_ + enough) chatter_.start_over(end - std::min(end, enough));
  seen_ = end;
  chatter_.follow(history, end, first, springs);
  return chatter_.there();
}

}  // namespace limpid
