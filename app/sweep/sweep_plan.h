// A sweep's plan in TOML: what it runs and measures; assets/sweeps/README.md describes it.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "app/run/simulate.h"
#include "app/sweep/measures.h"
#include "devices/files/urdf_file.h"

namespace limpid {

// Choices besides parameters: files beside the plan or of the program.
struct SweepWorld {
  std::string device, scene, hand;  // empty: default; hand empty also if given by points
  SweepWorld with(const SweepWorld& chosen) const;  // `chosen` where it has a choice, else this
  friend bool operator<(const SweepWorld& a, const SweepWorld& b) {
    return std::tie(a.device, a.scene, a.hand) < std::tie(b.device, b.scene, b.hand);
  }
};

// A named value of an axis without numbers.
struct SweepCase {
  std::string name;
  SweepWorld world;                   // empty: the plan's
  std::vector<std::string> settings;  // key=value
};

enum class Spread : std::uint8_t { grid, random, latin, sobol };
inline constexpr const char* kSpreads[] = {"grid", "random", "latin", "sobol"};

struct SweepAxis {
  std::string name;  // name of its column
  std::string key;   // of a parameter, a body (body_axis.h), or one of those below; empty: cases
  std::string unit = "-";
  Spread spread = Spread::grid;
  bool logarithmic = false;
  std::vector<double> values;      // of a sampled axis: one for each sample
  std::vector<std::string> words;  // names of the values 0, 1, ...; empty: numbers
  std::vector<SweepCase> cases;
};
// Stiffness of everything in the scene [N/m].
inline constexpr const char* kStiffnessKey = "scene.stiffness";
// Random arm in the device's place: number of joints, mass of all links, seed.
inline constexpr const char* kArmJointsKey = "arm.joints";
inline constexpr const char* kArmMassKey = "arm.mass";  // [kg]
inline constexpr const char* kArmSeedKey = "arm.seed";

// A measure that must stay on one side.
struct SweepLimit {
  const MeasureInfo* measure = nullptr;
  std::optional<double> above, below;

  // Whether `value` is within the limits; for a yes/no measure without limits, whether it is 1.
  bool met(double value) const;
};
struct StopRule {
  SweepLimit limit;
  double after = 0;  // [s]
};

// Search for where a condition changes along an axis, in place of one run a point.
struct SweepBoundary {
  SweepAxis axis;  // its values are tried in order; a change lies between two that differ
  SweepLimit condition;
  double tolerance = 0;  // final width of the search [the axis' unit]; a ratio if logarithmic
};

// Start of a hand and its jump within the first tick, in place of a path.
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
  std::string text;                   // the plan's own
  std::filesystem::path file;         // file that the plan came from
  Xacro xacro = Xacro::refuse;        // for arms that the plan names
  std::vector<std::string> settings;  // key=value, of all points
  Parameters parameters;              // with these settings, for the built-in arm
  SweepWorld world;
  std::optional<SweepJump> jump;
  std::optional<double> tap;  // force of a tap on a wall, in place of a path and a scene [N]
  double seconds = 0;         // of every run; 0: the hand's
  std::uint64_t seed = 0, samples = 1, repeats = 1, block = 1;
  std::vector<SweepAxis> axes;  // without the boundary's
  std::vector<const MeasureInfo*> measures;
  std::vector<StopRule> stops;
  std::optional<SweepBoundary> boundary;
  FigureWish figure;
  std::map<SweepWorld, std::shared_ptr<const RunPlan>> worlds;  // all that its points need
  std::uint64_t key = 0;  // digest of the plan and all files that it names

  // Points are numbered from 0: repeats fastest, then samples, then the last axis of the grid.
  std::uint64_t points() const;
};

// Reads a plan, and all files that it names. Errors: FileError FILE:LINE with key, what was found
// and what is allowed, also for hands out of reach.
SweepPlan read_sweep_plan(const std::filesystem::path& file, Xacro xacro = Xacro::refuse);
// Reads the text of a plan that once stood in `file`. Leaves out worlds, runs and key: their files
// may be gone by now.
SweepPlan plan_of_text(std::string text, const std::filesystem::path& file);
// Reads the worlds of the plan's points. Errors: as above.
void read_worlds(SweepPlan& plan);

// A point of the plan.
struct SweepPoint {
  std::vector<std::size_t> place;  // index of each axis' value
  std::vector<double> values;      // of each axis
  std::uint64_t repeat = 0;
};
SweepPoint point_of(const SweepPlan& plan, std::uint64_t index);
// Number of the point at these places of the axes and, on sampled ones, this sample.
std::uint64_t number_of(const SweepPlan& plan, const std::vector<std::size_t>& place,
                        std::uint64_t sample, std::uint64_t repeat);
// The run of a point; `at`: the value on the boundary's axis, if the plan has one.
RunPlan run_of(const SweepPlan& plan, std::uint64_t index, std::optional<double> at = {});

}  // namespace limpid
