// The settings of a story's two runs, step by step.
#pragma once

#include <array>
#include <vector>

#include "app/run/simulate.h"
#include "devices/files/toml_reader.h"

namespace limpid {

class StorySettings {
 public:
  // Takes in what a step that begins at time [s] says under `set` (both runs), `first` and `twin`.
  // Errors: FileError.
  void read(const TomlTable& step, const std::string& where, double time);

  const Parameters& now(std::size_t lane) const { return now_[lane]; }
  // What the runs begin with, and what changes at which row.
  void into(RunPlan& plan) const;

 private:
  struct Change {
    double time;
    std::string setting;
  };
  std::array<Parameters, 2> began_, now_;
  std::array<std::vector<Change>, 2> changes_;
};

}  // namespace limpid
