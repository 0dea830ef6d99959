// What somebody chose to see in a plot, by the names of channels: the same for every arm and run.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "app/plot/plot_spec.h"
#include "app/plot/trace_channels.h"
#include "devices/files/session/session.h"

namespace limpid {

struct PlotChoice {
  std::string title = {};  // empty: what it shows is its title
  PlotKind kind = PlotKind::time;
  std::string across = {};                 // kind cross: the channel along the horizontal axis
  std::vector<std::string> channels = {};  // their keys

  friend bool operator==(const PlotChoice&, const PlotChoice&) = default;
};

// As files have a kind: "time", "cross", "spectrum".
const char* name(PlotKind kind);

// Coordination error, controller energy, torques, and error against contact torque.
std::vector<PlotChoice> default_plots();

// What the curves of two runs are called, in front of what they show.
struct RunNames {
  std::string first, second;        // of one run both are empty
  bool twin = false;                // the second is another one now, not one of before
  std::array<int, 2> laws{-1, -1};  // of a twin's runs, by their numbers, as far as they are known

  friend bool operator==(const RunNames&, const RunNames&) = default;
};

// The laws of a session's runs at a time of it [s].
std::array<int, 2> laws_at(const Session& session, double time);

// Channels that the arm does not have are left out. A second run's channels follow the first one's
// and are drawn beside them, if it has a name.
PlotSpec plot_spec(const PlotChoice& choice, const TraceChannels& channels, const RunNames& names);

// What a plot without a title of its own is called.
std::string title_of(const PlotChoice& choice, const TraceChannels& channels);

}  // namespace limpid
