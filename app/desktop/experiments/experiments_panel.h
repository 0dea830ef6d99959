// Panel of the paper's experiments: runs them, shows figure and verdict, plays every trial.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/base/tasks.h"
#include "app/desktop/base/notices.h"
#include "app/desktop/widgets/picture_shelf.h"
#include "app/experiments/experiment.h"
#include "app/experiments/experiment_arm.h"
#include "app/plot/plot_frame.h"
#include "core/dynamics/arm_description.h"

namespace limpid {

class ExperimentsPanel {
 public:
  explicit ExperimentsPanel(Notices& notices) : notices_(notices) {}

  // Draws a window beside the picture while `open`; closing it clears `open`, and experiments go
  // on. `arm`: the one on the screen, on which they may run as well. `view`: place of the picture.
  // Returns the trial to be played, if one was chosen.
  std::filesystem::path draw(bool& open, ScreenRect view, const ArmDescription& arm);
  // Returns "3 of 12: zwidth, 40 s left"; empty while none runs.
  std::string under_way() const;
  double part() const { return running_.part(); }  // of the running experiment, 0 to 1
  void drop_pictures();                            // before the OpenGL context goes

 private:
  struct Verdict {
    Outcome outcome;
    std::filesystem::path file = {};  // of the figure
    std::optional<PictureTexture> figure = {};
    std::optional<Theme> shown_in = {};  // theme that the figure was loaded for
    std::vector<std::filesystem::path> trials = {};
  };

  // An arm that may be chosen.
  struct Offered {
    ExperimentArm arm;
    std::map<std::string, std::string> refusals;  // of experiments that do not run on it
  };

  const Offered& on() const { return offered_[on_]; }
  const std::string& refusal(const Experiment& experiment) const;
  std::filesystem::path dir() const;  // of results on the chosen arm
  Verdict* verdict_of(const Experiment& experiment);
  void offer(const ArmDescription& arm);
  void start(const Experiment& experiment);
  void take();
  void draw_arm();
  void draw_list();
  void draw_buttons();
  void draw_state(const Experiment& experiment);
  void draw_words(const Experiment& experiment);
  static void draw_figure(const PictureTexture& figure);
  void show_figure(Verdict& verdict);
  std::filesystem::path draw_verdict(Verdict& verdict);

  Notices& notices_;
  Task<Outcome> running_;
  const Experiment* current_ = nullptr;  // the one that runs
  const Experiment* shown_ = nullptr;
  bool chosen_ = false;    // the user chose shown_; else the latest result is shown
  bool stopping_ = false;  // the user asked the experiment to stop
  std::vector<const Experiment*> queue_;
  std::vector<Offered> offered_;                       // the built-in arm first
  std::size_t on_ = 0;                                 // the chosen one
  std::pair<std::string, std::string> offered_for_;    // text and tip of the arm on the screen
  std::map<std::filesystem::path, Verdict> verdicts_;  // by folder and name of the experiment
  double began_ = 0;                                   // [s of ImGui's time]
  int begun_ = 0;                                      // experiments begun since none ran
};

}  // namespace limpid
