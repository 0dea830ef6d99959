// Plots that a user has chosen, by the names of channels: the same for every arm and run.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "app/plot/plot_spec.h"
#include "app/plot/trace_channels.h"
#include "devices/files/session/session.h"

namespace limpid {

struct PlotChoice {
  std::string title = {};  // if empty, title_of() finds one
  PlotKind kind = PlotKind::time;
  std::string across = {};  // for PlotKind::cross: the channel along the horizontal axis
  std::vector<std::string> channels = {};  // keys of the channels

  friend bool operator==(const PlotChoice&, const PlotChoice&) = default;
};

// Returns the kind's name in files: "time", "cross", "spectrum".
const char* name(PlotKind kind);

// Returns plots of coordination error, controller energy, torques, and error against contact
// torque.
std::vector<PlotChoice> default_plots();

// Names of two runs, in front of their curves' labels.
struct RunNames {
  std::string first, second;        // both empty for a single run
  bool twin = false;                // the second runs beside the first, and not before it
  std::array<int, 2> laws{-1, -1};  // numbers of a twin's laws; -1: unknown

  friend bool operator==(const RunNames&, const RunNames&) = default;
};

// Returns the laws of a session's runs at a time of the session [s].
std::array<int, 2> laws_at(const Session& session, double time);

// Returns the plot of a choice. Leaves out channels that the arm does not have. A second run's
// channels follow the first one's and are drawn beside them, if the run has a name.
PlotSpec plot_spec(const PlotChoice& choice, const TraceChannels& channels, const RunNames& names);

// Returns the choice's title, or one made of its channels.
std::string title_of(const PlotChoice& choice, const TraceChannels& channels);

}  // namespace limpid
