// A script that plays itself: where the hand goes, which settings two runs on it have when, where
// to look from, and a sentence for each step. Its file is TOML; assets/stories/README.md says how
// to write one.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/run/simulate.h"
#include "render/camera.h"

namespace limpid {

// Where to look from: all of `of`, or of the arm and what it can touch.
struct StoryCamera {
  Camera::View view = Camera::View::iso;
  std::optional<Bounds> of = {};  // [m]
};

struct StoryStep {
  double begins = 0, ends = 0;  // [s]
  std::string caption;          // a sentence
  std::string mark;             // in the plots where it begins; empty: none
  std::array<std::string, 2> names;
  bool beside = true;                      // the second run is shown, too
  bool anew = false;                       // the plots begin anew
  std::optional<StoryCamera> camera = {};  // none: as in the step before
};

struct Story {
  std::string title;
  std::vector<StoryStep> steps;  // one at least, from 0 on, one after the other
  RunPlan plan;                  // with a twin, always

  double seconds() const { return steps.back().ends; }
};

// The step at that time [s]; the last one holds to the end.
const StoryStep& step_at(const std::vector<StoryStep>& steps, double time);

// Where to look from in that step, whichever step said so.
StoryCamera camera_in(const std::vector<StoryStep>& steps, const StoryStep& step);

// Errors: FileError "FILE:LINE: KEY: ..." for text that is not TOML, keys that are unknown or
// missing, values that are not allowed, steps or points of the hand that are not in order, points
// the arm does not reach.
Story read_story(const std::filesystem::path& file);
// The same of a text; files that it names lie in `folder`, or among the program's own.
Story parse_story(const std::string& text, const std::string& where,
                  const std::filesystem::path& folder);

std::filesystem::path default_story();

}  // namespace limpid
