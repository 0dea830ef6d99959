// The paper's experiments in the window: run them, see figure and verdict, play every trial.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "app/desktop/picture_texture.h"
#include "app/desktop/workbench.h"
#include "app/experiments/experiment.h"

namespace limpid {

class ExperimentsPanel {
 public:
  // A window over the others while it is the open dialog.
  void draw(Workbench& bench);

 private:
  struct Verdict {
    Outcome outcome;
    std::optional<PictureTexture> figure;
    std::vector<std::filesystem::path> trials;
  };

  void start(const Experiment& experiment);
  void take(Workbench& bench);
  void draw_list(Workbench& bench);
  void draw_verdict(Workbench& bench, const Verdict& verdict);

  Background<Outcome> running_;
  const Experiment* current_ = nullptr;  // that runs
  const Experiment* shown_ = nullptr;
  std::vector<const Experiment*> queue_;
  std::map<std::string, Verdict> verdicts_;
  double began_ = 0;  // [s of ImGui's time]
};

}  // namespace limpid
