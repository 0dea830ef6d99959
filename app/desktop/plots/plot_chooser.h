// Chooser of a plot's content: channels by a filter and a list, horizontal axis, and name.
#pragma once

#include <string>
#include <vector>

#include "app/plot/plot_frame.h"
#include "app/stage/stage.h"

namespace limpid {

// Returns the channels that have each of these words, or another word for it, in group, name,
// label, unit or key. Channels whose names have them come first, then those that people look at
// most.
std::vector<const ChannelInfo*> meant_by(const std::string& words, const TraceChannels& channels);

// Kind of a channel that is dragged; it carries the channel's key.
constexpr const char* kDraggedChannel = "channel";

class PlotChooser {
 public:
  bool is_open() const { return was_open_; }
  // Draws the chooser while `open`, above the plots; changes `choice` at each click. `anchor`: free
  // room [px]. Returns true when the plot is to be removed.
  bool draw(bool& open, PlotChoice& choice, const TraceChannels& channels, ScreenRect anchor);

 private:
  void draw_kinds(PlotChoice& choice, const TraceChannels& channels);
  void draw_filter(PlotChoice& choice, const TraceChannels& channels);
  void draw_list(PlotChoice& choice, const TraceChannels& channels) const;
  void draw_channel(PlotChoice& choice, const ChannelInfo& channel, const std::string& name) const;

  bool was_open_ = false, done_ = false;
  std::string filter_;
};

}  // namespace limpid
