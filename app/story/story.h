// Stories: scripts that play themselves. For each step a script gives the hand's path, the settings
// of all runs on it, the view, and a sentence. Its file is TOML; assets/stories/README.md says how
// to write one.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/run/simulate.h"
#include "core/dynamics/arm_description.h"
#include "devices/files/session/hand_file.h"
#include "devices/files/toml_reader.h"
#include "render/camera.h"

namespace limpid {

// View of all of `of`, or of the arm and what it can touch.
struct StoryCamera {
  Camera::View view = Camera::View::iso;
  std::optional<Bounds> of = {};  // [m]
};

struct StoryStep {
  double begins = 0, ends = 0;             // [s]
  std::string caption;                     // a sentence
  std::string mark;                        // in the plots at its beginning; empty: none
  std::vector<std::string> names;          // of all runs
  bool beside = true;                      // further runs are shown, too
  bool anew = false;                       // the plots begin anew
  std::optional<StoryCamera> camera = {};  // none: as in the step before
};

struct Story {
  std::string title;
  std::vector<StoryStep> steps;  // at least one, from 0 on, one after the other
  RunPlan plan;                  // of two or three lanes

  double seconds() const { return steps.back().ends; }
};

// Returns the step at that time [s]; the last one holds to the end.
const StoryStep& step_at(const std::vector<StoryStep>& steps, double time);

// Returns the view in that step: its own, or that of the latest step before that has one.
StoryCamera camera_in(const std::vector<StoryStep>& steps, const StoryStep& step);

// Reads a story. Errors: FileError "FILE:LINE: KEY: ..." for text that is not TOML, keys that are
// unknown or missing, values that are not allowed, steps or points of the hand that are not in
// order, points the arm does not reach.
Story read_story(const std::filesystem::path& file);
// Reads the same from a text; files that it names lie in `folder`, or among the program's own.
Story parse_story(const std::string& text, const std::string& where,
                  const std::filesystem::path& folder);

std::filesystem::path default_story();

// Spells a view as scripts and sessions' files do.
const char* view_word(Camera::View view);

// Return nothing where the key is missing. Errors of all: FileError for values that are not
// allowed.
std::optional<StoryCamera> camera_said(const TomlTable& step, const std::string& where);
std::optional<std::vector<std::string>> names_said(const TomlTable& step);
bool flag_in(const TomlTable& step, const char* key, bool otherwise);

// Settings of a story's runs, step by step: two, or three if the first step has `lane3`.
class StorySettings {
 public:
  // `base`: the settings where no step says otherwise.
  explicit StorySettings(const Parameters& base = {}) : now_(2, base) {}

  // Takes in the settings that a step beginning at `time` [s] has under `set` (all runs), `first`,
  // `twin` and `lane3`. Errors: FileError.
  void read(const TomlTable& step, const std::string& where, double time);

  std::span<const Parameters> now() const { return now_; }
  // Puts into the plan the settings at the beginning, and the later changes at their rows.
  void into(RunPlan& plan) const;

 private:
  struct Change {
    double time;
    std::string setting;
  };
  std::vector<Parameters> began_, now_;
  std::vector<std::vector<Change>> changes_;
};

// Path of a story's hand, step by step.
class StoryHand {
 public:
  StoryHand(const ArmDescription& arm, std::string where, std::filesystem::path folder)
      : arm_(arm), where_(std::move(where)), folder_(std::move(folder)) {}

  // Takes in the `hand` of a step from `begins` to `ends` [s]: a file, or points with their times
  // after the step's beginning. Without `hand` it stays in place. Errors: FileError, also for
  // points that the arm does not reach.
  void read(const TomlTable& step, double begins, double ends);

  HandPath path() const;

 private:
  void read_points(const TomlTable& step, double begins, double ends);
  void read_file(const TomlTable& step, const std::string& file, double begins, double ends);
  void add(double time, const Vec3& point, std::uint32_t line);

  const ArmDescription& arm_;
  std::string where_;
  std::filesystem::path folder_;
  std::vector<double> time_;
  std::vector<Vec3> position_;
  Eigen::VectorXd near_;  // configuration with the tip on the last point [rad]
};

}  // namespace limpid
