// Draft of a sweep: what the window asks for, and the text of its plan.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/tick/parameters.h"

namespace limpid {

// Axis of a grid: numbers, or words of a choice.
struct DraftAxis {
  std::string key;  // as in a plan
  double from = 0, to = 1;
  std::uint64_t count = 8;
  bool logarithmic = false;
  std::vector<std::string> words = {};  // in place of numbers
};

struct SweepDraft {
  std::string title = {};
  std::string device = {}, scene = {};  // files; empty: the default
  std::string hand = {};                // file of a path or a recording; empty: a tap
  double tap = 4;              // force of the tap, on a wall of its own in place of the scene [N]
  double seconds = 0;          // of each run; 0: as long as the hand
  Parameters parameters = {};  // of all runs
  std::vector<DraftAxis> axes = {};
  std::vector<std::string> measures = {};
};

// Returns "energy_highest over eta", for the name of its folder.
std::string short_name(const SweepDraft& draft);

// Returns a plan in TOML, as assets/sweeps/README.md describes it. Settings that have their usual
// value, or are on an axis, are left out.
std::string plan_text(const SweepDraft& draft);

}  // namespace limpid
