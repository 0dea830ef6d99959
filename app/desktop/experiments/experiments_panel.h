// Panel of the paper's experiments: runs them, shows figure and verdict, plays every trial.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/base/tasks.h"
#include "app/desktop/base/notices.h"
#include "app/desktop/widgets/picture_shelf.h"
#include "app/experiments/experiment.h"
#include "app/plot/plot_frame.h"

namespace limpid {

class ExperimentsPanel {
 public:
  explicit ExperimentsPanel(Notices& notices) : notices_(notices) {}

  // Draws a window beside the picture while `open`; closing it clears `open`, and experiments go
  // on. `view`: place of the picture. Returns the trial to be played, if one was chosen.
  std::filesystem::path draw(bool& open, ScreenRect view);
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

  void start(const Experiment& experiment);
  void take();
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
  std::map<std::string, Verdict> verdicts_;
  double began_ = 0;  // [s of ImGui's time]
  int begun_ = 0;     // experiments begun since none ran
};

}  // namespace limpid
