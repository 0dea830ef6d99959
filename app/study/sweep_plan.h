// What a sweep runs and measures, from a plan in TOML; assets/sweeps/README.md describes it.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "app/run/simulate.h"
#include "app/study/measures.h"
#include "devices/files/urdf_file.h"

namespace limpid {

// What can be chosen besides parameters: files beside the plan or among the program's own.
struct SweepWorld {
  std::string device, scene, hand;                  // empty: the default; a hand's points: empty
  SweepWorld with(const SweepWorld& chosen) const;  // what is said there in place of this
  friend bool operator<(const SweepWorld& a, const SweepWorld& b) {
    return std::tie(a.device, a.scene, a.hand) < std::tie(b.device, b.scene, b.hand);
  }
};

// A value of an axis that has names instead of numbers.
struct SweepCase {
  std::string name;
  SweepWorld world;                   // empty: the plan's
  std::vector<std::string> settings;  // key=value
};

enum class Spread : std::uint8_t { grid, random, latin, sobol };
inline constexpr const char* kSpreads[] = {"grid", "random", "latin", "sobol"};

struct SweepAxis {
  std::string name;  // of its column
  std::string key;   // a parameter's, a body's (body_axis.h), or one of those below; empty: cases
  std::string unit = "-";
  Spread spread = Spread::grid;
  bool logarithmic = false;
  std::vector<double> values;      // of a sampled axis: of each sample
  std::vector<std::string> words;  // what 0, 1, ... stand for; empty: numbers
  std::vector<SweepCase> cases;
};
// Of everything in the scene [N/m].
inline constexpr const char* kStiffnessKey = "scene.stiffness";
// Of a random arm in the device's place: how many joints, what its links weigh together, which one.
inline constexpr const char* kArmJointsKey = "arm.joints";
inline constexpr const char* kArmMassKey = "arm.mass";  // [kg]
inline constexpr const char* kArmSeedKey = "arm.seed";

// A measure that must stay on one side.
struct SweepLimit {
  const MeasureInfo* measure = nullptr;
  std::optional<double> above, below;

  // Whether its value is there; of a yes/no measure without a limit, whether it is 1.
  bool met(double value) const;
};
struct StopRule {
  SweepLimit limit;
  double after = 0;  // [s]
};

// Instead of one run a point: where along an axis a condition changes.
struct SweepBoundary {
  SweepAxis axis;  // its values, in their order, are tried; where two differ lies a change
  SweepLimit condition;
  double tolerance = 0;  // of the axis [its unit]; of the ratio, if it is logarithmic
};

// Where a hand is and jumps to within the first tick, in place of a path.
struct SweepJump {
  Vec3 at = Vec3::Zero(), by = Vec3::Zero();  // [m]
};

struct FigureWish {
  std::string x, y;                 // axes; empty: the first two that have numbers
  std::string measure;              // empty: the first
  std::vector<std::string> theory;  // lines: kTheories
  std::string caption;
};
inline constexpr const char* kTheories[] = {"pr", "routh", "routh_compliant"};

struct SweepPlan {
  std::string title;
  std::string text;             // the plan's own
  std::filesystem::path file;   // it came from
  Xacro xacro = Xacro::refuse;  // of arms that it names
  Parameters parameters;
  SweepWorld world;
  std::optional<SweepJump> jump;
  std::optional<double> tap;  // in place of a path and a scene: how hard a wall is tapped [N]
  double seconds = 0;         // of every run; 0: the hand's
  std::uint64_t seed = 0, samples = 1, repeats = 1, block = 1;
  std::vector<SweepAxis> axes;  // without a boundary's
  std::vector<const MeasureInfo*> measures;
  std::vector<StopRule> stops;
  std::optional<SweepBoundary> boundary;
  FigureWish figure;
  std::map<SweepWorld, std::shared_ptr<const RunPlan>> worlds;  // all that its points need
  std::uint64_t key = 0;  // stands for the plan and all the files that it names

  // Points are numbered from 0: repeats fastest, then samples, then the last axis of the grid.
  std::uint64_t points() const;
};

// Errors: FileError FILE:LINE with key, what was found and what is allowed, also for files that the
// plan names and for hands out of reach.
SweepPlan read_sweep_plan(const std::filesystem::path& file, Xacro xacro = Xacro::refuse);
// The same of a plan's text that once stood in `file`. Without its worlds, runs and key: what they
// need may be gone by now.
SweepPlan plan_of_text(std::string text, const std::filesystem::path& file);
// Reads what they need. Errors: as above.
void read_worlds(SweepPlan& plan);

// One of them.
struct SweepPoint {
  std::vector<std::size_t> place;  // of each axis' value
  std::vector<double> values;      // of each axis
  std::uint64_t repeat = 0;
};
SweepPoint point_of(const SweepPlan& plan, std::uint64_t index);
// The number of the point at these places of the axes (of sampled ones: at this sample).
std::uint64_t number_of(const SweepPlan& plan, const std::vector<std::size_t>& place,
                        std::uint64_t sample, std::uint64_t repeat);
// The run of a point; where there is a boundary, with its axis at `at`.
RunPlan run_of(const SweepPlan& plan, std::uint64_t index, std::optional<double> at = {});

}  // namespace limpid
