// A run without a window: a hand's path through the rig, as fast as it goes or paced.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/run/scene_meshes.h"
#include "core/tick/parameters.h"
#include "devices/files/session/hand_file.h"
#include "devices/files/session/session.h"
#include "devices/simulated/rig.h"

namespace limpid {

// Settings of one run on the hand of a plan, in its world.
struct Lane {
  Parameters parameters;               // at the first row; the tick is the first lane's
  std::vector<SettingChange> changes;  // later ones
  // Default: at rest, the tip on the hand's first point; further lanes start as the first one.
  std::optional<RigStart> start = {};
};

// All that decides a run: the same plan gives the same rows, bit for bit. A plan is its own first
// lane.
struct RunPlan : Lane {
  ArmDescription arm;
  SceneDocument document;
  MeshModels models;  // to draw the scene's meshes
  HandPath hand;
  std::vector<double> hand_torque;  // N x n [N m], instead of a grip; empty: the hand's path leads
  std::vector<bool> force;          // armed at each row of a recording; empty: always
  // Force that the motors are asked to make at the tip at each row, to measure the grip [N]; none
  // from its end on.
  std::vector<Vec3> excitation;
  std::uint64_t rows = 0;    // number of ticks
  std::uint64_t seed = 0;    // for everything random
  std::vector<Lane> beside;  // further lanes, at most kMostLanes - 1
  std::string note = {};     // for people: why rows of a re-run may differ from the recorded ones

  std::size_t lanes() const { return 1 + beside.size(); }
  const Lane& lane(std::size_t i) const { return i == 0 ? *this : beside[i - 1]; }
  // Returns the parameters of each lane at the first row.
  std::vector<Parameters> settings() const;
  RowLayout layout() const { return row_layout(arm.dof(), document.scene); }  // of each lane's rows
};

// Returns the number of ticks of length T in that time [s], at least one.
std::uint64_t ticks_in(double duration, double T);

// Returns what a hand that follows the path does over its k-th tick of length T [s].
HandInput input_at(const HandPath& path, std::size_t k, double T);

// Parameters of each lane that have just changed, else null.
using LaneChanges = std::span<const Parameters* const>;
// Takes each tick's rows, lane behind lane; returning false ends the run.
using RowSink = std::function<bool(std::span<const double> rows, LaneChanges changed)>;

struct RunEnd {
  std::uint64_t rows = 0;  // number of rows that were run
  bool diverged = false;   // unstable at the last of them
  bool stopped = false;    // by the sink or by `stop`
  double diverged_at = 0;  // time of the first row that no arm could follow, if it diverged [s]
  std::string why = {};    // fault of that row, in words
};

// Returns the end of a run that was recorded whole.
RunEnd end_of(const Session& session);

struct RunPace {
  bool realtime = false;                    // the haptic thread paces it at the tick rate
  const std::atomic<bool>* stop = nullptr;  // set it to end early
};

// Makes a recorded change. Errors: ParameterError.
void apply_change(Parameters& p, const SettingChange& change);

// Runs all lanes in lockstep. Ends early if one of them diverges (DivergenceWatch). Errors:
// std::invalid_argument if the hand's first point cannot be reached; ParameterError in a recorded
// change.
RunEnd simulate(const RunPlan& plan, const RunPace& pace, const RowSink& sink);

}  // namespace limpid
