// What the plots of one window share: the stretch of time they show and the moment pointed at.
#pragma once

#include <optional>

#include "app/plot/history.h"

namespace limpid {

class PlotGroup {
 public:
  // `fitted_length` [s]: how much fit() shows of a long history; a recording's duration shows it
  // all.
  explicit PlotGroup(double fitted_length = 10) : fitted_length_(fitted_length) { fit(); }

  // Once a frame before the plots are drawn. `playback` [s on the history's axis]: where playback
  // stands; while following, the window keeps it in view instead of the newest data.
  void begin_frame(const History& history, std::optional<double> playback = std::nullopt);

  double start() const { return stop_ - length_; }
  double stop() const { return stop_; }
  double length() const { return length_; }
  std::optional<double> playback() const { return playback_; }

  // Following: the window moves with the newest data or with playback.
  bool following() const { return following_; }
  void set_following(bool on) { following_ = on; }

  // Moves the window by `seconds`; stops following unless that brings the newest data into view.
  void pan(double seconds);

  // `factor` > 1 shows more. The time `around` stays where it is, unless the window follows the
  // newest data: then that stays.
  void zoom(double factor, double around);

  // Follow, with the fitted length.
  void fit();
  void set_fitted_length(double seconds) { fitted_length_ = seconds; }

  // Under the mouse, in any of the plots.
  std::optional<double> hovered() const { return hovered_; }
  void hover(double time) { hovered_ = hovering_ = time; }
  // The same in spectra [Hz].
  std::optional<double> hovered_frequency() const { return hovered_frequency_; }
  void hover_frequency(double f) { hovered_frequency_ = hovering_frequency_ = f; }

 private:
  double fitted_length_;
  double length_ = 0;
  double stop_ = 0;
  bool following_ = true;
  double data_start_ = 0;
  double data_stop_ = 0;
  double shortest_ = 0.01;
  std::optional<double> playback_;
  std::optional<double> hovered_;
  std::optional<double> hovering_;  // said during this frame, for plots drawn earlier in the next
  std::optional<double> hovered_frequency_, hovering_frequency_;
};

}  // namespace limpid
