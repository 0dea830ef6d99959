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

// One run on the hand of a plan, in its world, under settings of its own.
struct Lane {
  Parameters parameters;               // at the first row; the tick is the first lane's
  std::vector<SettingChange> changes;  // later ones
  // Default: at rest, the tip on the hand's first point; of further lanes where the first one
  // starts.
  std::optional<RigStart> start = {};
};

// All that decides a run: the same plan gives the same rows, bit for bit. It is its own first lane.
struct RunPlan : Lane {
  ArmDescription arm;
  SceneDocument document;
  MeshModels models;  // what the scene's meshes look like
  HandPath hand;
  std::vector<double> hand_torque;  // N x n [N m], instead of a grip; empty: the hand's path leads
  std::vector<bool> force;          // armed at each row of a recording; empty: always
  std::uint64_t rows = 0;           // how many ticks
  std::uint64_t seed = 0;           // for whatever is random
  std::vector<Lane> beside;         // further lanes; one makes a twin
  std::string note = {};  // for people: why rows may come out otherwise than recorded; of a re-run

  std::size_t lanes() const { return 1 + beside.size(); }
  const Lane& lane(std::size_t i) const { return i == 0 ? *this : beside[i - 1]; }
  // What a recorder wants to know of the second lane; null: there is none.
  const Parameters* twin() const { return beside.empty() ? nullptr : &beside[0].parameters; }
  RowLayout layout() const { return row_layout(arm.dof(), document.scene); }  // of each lane's rows
};

// What a hand that follows the path does over its k-th tick of length T [s].
HandInput input_at(const HandPath& path, std::size_t k, double T);

// Called with each tick's rows, lane behind lane, and with the parameters of each lane whose own
// have just changed, else null. False ends the run.
using LaneChanges = std::span<const Parameters* const>;
using RowSink = std::function<bool(std::span<const double> rows, LaneChanges changed)>;

struct RunEnd {
  std::uint64_t rows = 0;  // that were run
  bool diverged = false;   // unstable at the last of them
  bool stopped = false;    // by the sink or by `stop`
  double diverged_at = 0;  // the first row that no arm could follow, where it diverged [s]
  std::string why = {};    // what that row had, in words
};

// The same of a run that was recorded to its end.
RunEnd end_of(const Session& session);

struct RunPace {
  bool realtime = false;                    // paced at the tick rate by the haptic thread
  const std::atomic<bool>* stop = nullptr;  // set it to end early
};

// Makes a recorded change. Errors: ParameterError.
void apply_change(Parameters& p, const SettingChange& change);

// All lanes in lockstep. Ends early where one of them diverges (DivergenceWatch). Errors:
// std::invalid_argument if the hand's first point cannot be reached; ParameterError in a recorded
// change.
RunEnd simulate(const RunPlan& plan, const RunPace& pace, const RowSink& sink);

}  // namespace limpid
