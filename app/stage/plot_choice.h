// Plots that a user has chosen, by the names of channels: the same for every arm and run.
#pragma once

#include <span>
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

// Returns what a first hour needs of them, without what tells of the observer and the motors.
std::vector<PlotChoice> simple_plots();

// Names of several runs, in front of their curves' labels.
struct RunNames {
  std::vector<std::string> names = {};  // fewer than two for a single run
  bool beside = false;         // all run at once; else the second is a re-run of the first,
                               // whose several curves in a plot are named as without it
  std::vector<int> laws = {};  // numbers of the runs' laws; -1: unknown

  bool several() const { return names.size() > 1; }
  std::string name(std::size_t run) const { return run < names.size() ? names[run] : ""; }
  int law(std::size_t run) const { return run < laws.size() ? laws[run] : -1; }
  friend bool operator==(const RunNames&, const RunNames&) = default;
};

// Returns the names and laws of lanes with these settings; a single lane has no name.
RunNames run_names(std::span<const Parameters> lanes);

// Returns the laws of a session's lanes at a time of the session [s].
std::vector<int> laws_at(const Session& session, double time);

// Returns the plot of a choice. Leaves out channels that the arm does not have. A further run's
// channels follow the first one's and are drawn beside them, if the run has a name.
PlotSpec plot_spec(const PlotChoice& choice, const TraceChannels& channels, const RunNames& names);

// Returns the choice's title, or one made of its channels.
std::string title_of(const PlotChoice& choice, const TraceChannels& channels);

}  // namespace limpid
