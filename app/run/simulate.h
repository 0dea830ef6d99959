// A run without a window: a hand's path through the rig, as fast as it goes or paced.
#pragma once

#include <array>
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

// A second run on the same hand, in the same world, under settings of its own.
struct TwinPlan {
  Parameters parameters;               // at the first row; the tick is the other's
  std::vector<SettingChange> changes;  // later ones
  std::optional<RigStart> start;       // default: where the other run starts
};

// All that decides a run: the same plan gives the same rows, bit for bit.
struct RunPlan {
  ArmDescription arm;
  SceneDocument document;
  MeshModels models;  // what the scene's meshes look like
  HandPath hand;
  Parameters parameters;               // at the first row
  std::vector<SettingChange> changes;  // later ones, of a recording that is run again
  std::vector<double> hand_torque;  // N x n [N m], instead of a grip; empty: the hand's path leads
  std::vector<bool> force;          // armed at each row of a recording; empty: always
  std::optional<RigStart> start;    // default: at rest, the tip on the hand's first point
  std::uint64_t rows = 0;           // how many ticks
  std::uint64_t seed = 0;           // for whatever is random
  std::optional<TwinPlan> twin;
  std::string note = {};  // for people: why rows may come out otherwise than recorded; of a re-run
};

// Called with each row in turn, and with the parameters if they have just changed. False ends the
// run.
using RowSink = std::function<bool(std::span<const double> row, const Parameters* changed)>;

// The same of a twin: its two rows, one behind the other, and each run's parameters if they have
// just changed.
using TwinSink =
    std::function<bool(std::span<const double> rows, std::array<const Parameters*, 2> changed)>;

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

// Ends early where the loop diverges (DivergenceWatch). Errors: std::invalid_argument if the hand's
// first point cannot be reached; ParameterError in a recorded change.
RunEnd simulate(const RunPlan& plan, const RunPace& pace, const RowSink& sink);
// Both runs of a plan with a twin, in lockstep; ends where either diverges.
RunEnd simulate_twin(const RunPlan& plan, const RunPace& pace, const TwinSink& sink);

}  // namespace limpid
