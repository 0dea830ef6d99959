// One quantity over time, drawn with ImGui: curves, axes, legend, read-out and what the mouse does.
#pragma once

#include <optional>
#include <vector>

#include "app/plot/autoscale.h"
#include "app/plot/plot_frame.h"
#include "app/plot/plot_group.h"
#include "app/plot/plot_legend.h"
#include "app/plot/plot_menu.h"

namespace limpid {

struct PlotEvents {
  std::optional<double> playback;    // dragged here [s on the history's axis]
  std::optional<PlotNotice> notice;  // also shown in the plot itself
};

// Mouse: drag pans, wheel zooms time, Ctrl+wheel or the wheel over the value axis zooms values,
// double click fits, right click opens the menu, a click on the legend hides or shows a curve.
class Plot {
 public:
  explicit Plot(PlotSpec spec) : spec_(std::move(spec)) {}

  PlotSpec& spec() { return spec_; }
  const PlotSpec& spec() const { return spec_; }

  // Draws at ImGui's cursor, `size` [px]; needs PlotGroup::begin_frame() once before.
  PlotEvents draw(const History& history, PlotGroup& group, ImVec2 size,
                  const PlotSaving& saving = {});

  // Back to limits that follow the data.
  void fit_values();

 private:
  enum class Drag { none, pan, values, playback };

  PlotFrame lay_out(const History& history, const PlotGroup& group, ImVec2 size);
  void follow_data(const History& history, const PlotGroup& group);
  void choose_unit();
  void handle_mouse(const PlotFrame& frame, PlotGroup& group, PlotEvents& events);
  void handle_wheel(const PlotFrame& frame, PlotGroup& group);
  void handle_drag(const PlotFrame& frame, PlotGroup& group, PlotEvents& events);
  void zoom_values(double factor, double around);
  void draw_curves(const PlotFrame& frame, const History& history);
  float draw_title(ImDrawList& list, const ScreenRect& outer, float scale) const;
  void handle_menu(const PlotFrame& frame, const History& history, PlotGroup& group,
                   const PlotSaving& saving, PlotEvents& events);
  void save_png_when_due(const PlotFrame& frame, const PlotSaving& saving);
  void tell(PlotNotice notice, PlotEvents& events);
  void draw_latest_notice(const PlotFrame& frame);

  PlotSpec spec_;
  Limits y_;
  Autoscale autoscale_;
  bool values_follow_ = true;
  double run_start_ = 0;  // of the run that the limits follow [s]
  Drag drag_ = Drag::none;
  PlotLegend legend_;
  int hovered_curve_ = -1;
  bool hovered_ = false;
  std::vector<SampleIndex> rows_;
  std::vector<Trace> traces_;
  int frames_until_png_ = 0;
  std::optional<PlotNotice> notice_;
  double notice_until_ = 0;  // ImGui's time [s]
};

}  // namespace limpid
