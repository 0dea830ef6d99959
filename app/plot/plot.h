// A plot of a history's channels drawn with ImGui, and what all plots of a window share.
#pragma once

#include <optional>
#include <vector>

#include "app/plot/axis.h"
#include "app/plot/history.h"
#include "app/plot/plot_frame.h"
#include "app/plot/plot_legend.h"
#include "app/plot/plot_menu.h"

namespace limpid {

// A selected stretch of time, and the plot in which it was selected.
struct PlotRange {
  double start = 0, stop = 0;  // on the history's axis [s]
  std::size_t plot = 0;

  friend bool operator==(const PlotRange&, const PlotRange&) = default;
};

// State that all plots of one window share: the stretch of time they show and the moment pointed
// at.
class PlotGroup {
 public:
  // `fitted_length` [s]: the part of a long history that fit() shows; a recording's duration shows
  // it all.
  explicit PlotGroup(double fitted_length = 10) : fitted_length_(fitted_length) { fit(); }

  // Is called once a frame before the plots are drawn. `playback`: its place [s on the history's
  // axis]; while following, the window keeps it in view instead of the newest data.
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

  // Shows more for `factor` > 1. The time `around` stays where it is; but if the window follows the
  // newest data, that stays.
  void zoom(double factor, double around);

  // Follows with the fitted length.
  void fit();
  void set_fitted_length(double seconds) { fitted_length_ = seconds; }

  // Returns the time under the mouse, in any of the plots.
  std::optional<double> hovered() const { return hovered_; }
  void hover(double time) { hovered_ = hovering_ = time; }
  // Returns what was selected, as long as there are rows of it.
  const std::optional<PlotRange>& range() const { return range_; }
  void select(const std::optional<PlotRange>& range) { range_ = range; }
  // Returns the frequency under the mouse in spectra [Hz].
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
  std::optional<double> hovering_;  // set during this frame, for plots drawn earlier in the next
  std::optional<PlotRange> range_;
  std::optional<double> hovered_frequency_, hovering_frequency_;
};

// Results of one frame: what the mouse did in a plot.
struct PlotEvents {
  std::optional<double> playback;    // dragged here [s on the history's axis]
  std::optional<PlotNotice> notice;  // also shown in the plot itself
  PlotWish wish = PlotWish::none;    // a wish that only the plots' owner can fulfil
  std::optional<PlotRange> range;    // selected here; the owner knows which plot it is
  bool unselect = false;             // Shift+click: unselects the range
};

// Curves, axes, legend and read-out of some channels. Mouse: drag pans, Shift+drag selects a
// stretch of time, wheel zooms along the horizontal axis, Ctrl+wheel or the wheel over the value
// axis zooms values, double click fits, right click opens the menu, a click on the legend hides or
// shows a curve. Over another channel the wheel zooms both axes.
class Plot {
 public:
  explicit Plot(PlotSpec spec) : spec_(std::move(spec)) {}

  PlotSpec& spec() { return spec_; }
  const PlotSpec& spec() const { return spec_; }
  // Shows another spec from now on, with the present limits where that makes sense.
  void show(PlotSpec spec);

  // Draws at ImGui's cursor, `size` [px]; needs PlotGroup::begin_frame() once before.
  PlotEvents draw(const History& history, PlotGroup& group, ImVec2 size,
                  const PlotSaving& saving = {});

  // Returns what the plot shows now, for a picture or a table.
  PlotPicture picture(const PlotGroup& group) const;
  // Returns the area in which the curves were drawn last [px].
  const ScreenRect& area() const { return area_; }
  // Lets the limits follow the data again.
  void fit_values();
  // Acts with the next draw() as if the menu had been asked for this.
  void ask(PlotWish wish) { asked_ = wish; }

 private:
  enum class Drag { none, pan, values, playback, range };

  // Value axis: its limits, and whether it moves with the data.
  struct ValueAxis {
    Limits limits;
    Autoscale autoscale;
    bool follows = true;

    void fit();
    // Scales by `factor` around a part of the axis.
    void zoom(double factor, double part);
    void pan(double parts);
  };

  PlotFrame lay_out(const History& history, const PlotGroup& group, ImVec2 size, bool menu);
  void follow_data(const History& history, const PlotGroup& group);
  void follow_values(ValueAxis& axis, const PlotAxis& spec, Extent data);
  void follow_spectra(const History& history, const PlotGroup& group);
  void handle_mouse(const PlotFrame& frame, const History& history, PlotGroup& group,
                    PlotEvents& events);
  void point_at(const PlotFrame& frame, const History& history, PlotGroup& group, ImVec2 mouse);
  void handle_wheel(const PlotFrame& frame, PlotGroup& group);
  void handle_drag(const PlotFrame& frame, const History& history, PlotGroup& group,
                   PlotEvents& events);
  void pan(const PlotFrame& frame, PlotGroup& group, ImVec2 by);
  void draw_curves(const PlotFrame& frame, const History& history);
  void draw_inside(const PlotFrame& frame, const History& history, const PlotGroup& group,
                   ImVec2 mouse);
  void draw_what_is_pointed_at(const PlotFrame& frame, const History& history,
                               const PlotGroup& group, ImVec2 mouse);
  float draw_title(ImDrawList& list, const ScreenRect& outer, float scale) const;
  PlotWish open_menu(const PlotSaving& saving);
  void handle_menu(const PlotFrame& frame, const History& history, PlotGroup& group,
                   const PlotSaving& saving, PlotEvents& events);
  void save_png_when_due(const PlotFrame& frame, const PlotSaving& saving);
  void tell(PlotNotice notice, PlotEvents& events);
  void draw_latest_notice(const PlotFrame& frame);
  bool over_time() const { return spec_.kind == PlotKind::time; }

  PlotSpec spec_;
  ValueAxis x_, y_;       // x_: over another channel or frequencies
  double run_start_ = 0;  // start of the run that the limits follow [s]
  Drag drag_ = Drag::none;
  double range_from_ = 0;  // start of the drag that selects [s]
  PlotLegend legend_;
  int hovered_curve_ = -1;
  bool hovered_ = false;
  std::vector<SampleIndex> rows_;
  std::vector<Trace> traces_;
  std::vector<AmplitudeSpectrum> spectra_;  // one for each curve
  double spectra_start_ = 0, spectra_stop_ = 0, spectra_due_ = 0;
  ScreenRect menu_button_{}, area_{};
  PlotWish asked_ = PlotWish::none;
  int frames_until_png_ = 0;
  std::optional<PlotNotice> notice_;
  double notice_until_ = 0;  // ImGui's time [s]
};

}  // namespace limpid
