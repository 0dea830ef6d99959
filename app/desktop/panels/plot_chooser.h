// Asks what a plot shows: channels by a filter and a list, over what, and its name.
#pragma once

#include <string>

#include "app/desktop/base/stage.h"
#include "app/plot/plot_frame.h"

namespace limpid {

// Whether a channel is meant by these words: each stands in its group, name, label, unit or key.
bool meant_by(const ChannelInfo& channel, const std::string& words);

class PlotChooser {
 public:
  // While `open`, above the plots; changes `choice` as it is clicked together. `anchor`: where
  // there is room [px]. Returns true when the plot is to be removed.
  bool is_open() const { return was_open_; }
  bool draw(bool& open, PlotChoice& choice, const TraceChannels& channels, ScreenRect anchor);

 private:
  void draw_kinds(PlotChoice& choice, const TraceChannels& channels);
  void draw_filter(PlotChoice& choice, const TraceChannels& channels);
  void draw_list(PlotChoice& choice, const TraceChannels& channels) const;
  void draw_channel(PlotChoice& choice, const ChannelInfo& channel) const;

  bool was_open_ = false, done_ = false;
  std::string filter_;
};

}  // namespace limpid
