// A sweep's table that is looked at: it follows its file while that fills, and its points can be
// run again.
#pragma once

#include <optional>

#include "app/desktop/playback/playback.h"
#include "app/plot/plot_frame.h"
#include "app/study/sweep_map.h"

namespace limpid {

class SweepController {
 public:
  explicit SweepController(Notices& notices) : notices_(notices) {}

  // The table comes in beside the window.
  void open(const std::filesystem::path& table);
  bool loading() const { return !asked_.empty(); }

  // What is shown, null before the first; the map follows choice and table a moment later.
  const OpenedSweep* sweep() const { return sweep_.get(); }
  const SweepMap* map() const { return map_ ? &*map_ : nullptr; }
  const MapChoice& choice() const { return choice_; }  // precondition: sweep()
  void choose(const MapChoice& choice);

  // Runs a point (of a boundary with its axis at `at`) beside the window and plays it then. Says so
  // where that cannot be; says, too, whether it came out as in the table.
  void play(std::uint64_t point, std::optional<double> at, Playback& playback);
  // The session of the last of them.
  const std::filesystem::path& last_point() const { return last_point_; }

  // Once a frame. True when a table has come that was asked for.
  bool update();
  std::uint64_t revision() const { return revision_; }  // of what there is to see

  // Where the map stands in the window, for who drives the window from outside; empty while it is
  // not shown.
  struct OnScreen {
    ScreenRect rect;
    std::optional<std::uint64_t> pointed_at;
  };
  std::optional<OnScreen> on_screen;

 private:
  using Time = std::filesystem::file_time_type;
  struct Look {
    std::shared_ptr<const OpenedSweep> sweep;  // null: the file is as it was
    Time changed;
  };
  struct Made {
    SweepMap map;
    std::shared_ptr<const OpenedSweep> of;
  };
  void look(const std::filesystem::path& file, bool anew);
  bool take_look();
  void follow_map();

  Notices& notices_;
  std::filesystem::path asked_;  // not there yet
  std::shared_ptr<const OpenedSweep> sweep_;
  std::optional<SweepMap> map_;
  MapChoice choice_;
  std::shared_ptr<const OpenedSweep> mapped_;  // that the map is of
  std::filesystem::path last_point_;
  std::chrono::steady_clock::time_point next_look_;
  Time changed_;
  std::uint64_t revision_ = 0;
  Task<Look> looking_;
  Task<Made> mapping_;
};

}  // namespace limpid
