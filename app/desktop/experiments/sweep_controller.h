// Controller of a sweep that is shown: follows its table's file while that fills, and runs its
// points again.
#pragma once

#include <optional>

#include "app/desktop/experiments/sweep_runner.h"
#include "app/desktop/playback/playback.h"
#include "app/plot/plot_frame.h"
#include "app/sweep/sweep_draft.h"
#include "app/sweep/sweep_map.h"

namespace limpid {

class SweepController {
 public:
  explicit SweepController(Notices& notices) : notices_(notices) {}

  // Loads the table beside the window.
  void open(const std::filesystem::path& table);
  bool loading() const { return !asked_.empty(); }

  // Returns the sweep shown, null before the first. The map follows choice and table a moment
  // later.
  const OpenedSweep* sweep() const { return sweep_.get(); }
  const SweepMap* map() const { return map_ ? &*map_ : nullptr; }
  const MapChoice& choice() const { return choice_; }  // precondition: sweep()
  void choose(const MapChoice& choice);

  // Starts a sweep beside the window in a new folder of the user's; its table is opened once it is
  // there. Precondition: !runner().busy().
  void start(const SweepDraft& draft);
  // Tells whether the sweep shown was stopped in this window, or an earlier one; goes on with it.
  bool may_go_on() const;
  void go_on();
  void stop() { runner_.stop(); }
  const SweepRunner& runner() const { return runner_; }
  const std::string& why_not_started() const { return why_not_started_; }  // empty: it was

  // Runs a point (of a boundary with its axis at `at`) beside the window, then plays it. Shows
  // notices on failure and on whether the results are as in the table.
  void play(std::uint64_t point, std::optional<double> at, Playback& playback);
  // Returns the session of the point that was played last.
  const std::filesystem::path& last_point() const { return last_point_; }

  // Does the work of a frame; to be called once a frame. Returns true when a table that was opened
  // has come.
  bool update();
  std::uint64_t revision() const { return revision_; }  // changes with all that is shown

  // Place of the map in the window, for programs that drive the window; empty while the map is not
  // shown.
  struct OnScreen {
    ScreenRect rect;
    std::optional<std::uint64_t> pointed_at;
  };
  std::optional<OnScreen> on_screen;

 private:
  using Time = std::filesystem::file_time_type;
  struct Look {
    std::shared_ptr<const OpenedSweep> sweep;  // null: the file is unchanged
    Time changed;
  };
  struct Made {
    SweepMap map;
    std::shared_ptr<const OpenedSweep> of;
  };
  void look(const std::filesystem::path& file, bool anew);
  bool take_look();
  void follow_map();
  void follow_runner();
  void work(const std::filesystem::path& folder);

  Notices& notices_;
  std::filesystem::path asked_;    // file of the table that is being loaded
  std::filesystem::path started_;  // table of the sweep that was started here
  int tries_ = 0;                  // left to open that table; 0: it is open
  std::shared_ptr<const OpenedSweep> sweep_;
  std::optional<SweepMap> map_;
  MapChoice choice_;
  std::shared_ptr<const OpenedSweep> mapped_;  // the sweep that map_ shows
  std::filesystem::path last_point_;
  std::chrono::steady_clock::time_point next_look_;
  Time changed_;
  std::uint64_t revision_ = 0;
  Task<Look> looking_;
  Task<Made> mapping_;
  std::string why_not_started_;
  SweepRunner runner_;
};

}  // namespace limpid
