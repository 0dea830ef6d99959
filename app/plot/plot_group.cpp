#include "app/plot/plot_group.h"

#include <algorithm>
#include <utility>

namespace limpid {
namespace {

constexpr double kShortestTicks = 8;
constexpr double kPlaybackPlace = 0.75;  // of the window, where playback runs when zoomed in

}  // namespace

void PlotGroup::begin_frame(const History& history, std::optional<double> playback) {
  data_start_ = history.start_time();
  data_stop_ = history.end_time();
  shortest_ = kShortestTicks * history.tick();
  playback_ = playback;
  hovered_ = std::exchange(hovering_, std::nullopt);
  hovered_frequency_ = std::exchange(hovering_frequency_, std::nullopt);
  const double earliest_stop = data_start_ + length_;
  if (following_ && playback_) {
    const double wanted = *playback_ + (1 - kPlaybackPlace) * length_;
    stop_ = std::max(earliest_stop, std::min(wanted, data_stop_));
  } else if (following_) {
    stop_ = std::max(earliest_stop, data_stop_);
  } else {
    // Some data stays in view, also when the oldest is being forgotten.
    const double some = 0.1 * length_;
    stop_ = std::clamp(stop_, data_start_ + some, data_stop_ + length_ - some);
  }
}

void PlotGroup::pan(double seconds) {
  stop_ += seconds;
  following_ = !playback_ && seconds > 0 && stop_ >= data_stop_ && stop_ >= data_start_ + length_;
}

void PlotGroup::zoom(double factor, double around) {
  const double longest =
      std::max({2 * fitted_length_, 1.2 * (data_stop_ - data_start_), shortest_});
  const double length = std::clamp(length_ * factor, shortest_, longest);
  if (!following_) stop_ = around + (stop_ - around) * length / length_;
  length_ = length;
}

void PlotGroup::fit() {
  length_ = fitted_length_;
  following_ = true;
}

}  // namespace limpid
