// Session that is played, with a second run of its hand beside it if one was made.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/base/tasks.h"
#include "app/desktop/playback/player.h"
#include "app/run/rerun.h"
#include "app/run/simulate.h"
#include "app/stage/stage.h"
#include "app/story/story.h"

namespace limpid {

// Fact on a recording.
struct Fact {
  std::string name, value;
};

// Session as loaded from its file.
struct LoadedSession {
  std::filesystem::path file;
  std::shared_ptr<const Session> session;
  ArmDescription arm;
  SceneDocument document;
  MeshModels models;
  History history;
  std::vector<StoryStep> steps = {};  // steps of the story; empty: not a story
  std::string said = {};              // notice to show with it; empty: none
  bool bad = false;                   // `said` reports a fault
  std::vector<Fact> facts = {};       // description of the recording beside its settings
  std::vector<Fact> verdict = {};     // measures of the recording
};

// Settings of one lane of a recording, as they were at a row.
class RecordedSettings {
 public:
  // Errors: FileError if the session's settings cannot be read.
  RecordedSettings(const Session& session, const std::string& where);

  const Parameters& at(std::size_t row);
  const Parameters& began() const { return began_; }  // at the first row

 private:
  const Session* session_;
  Parameters began_, now_;
  std::size_t made_ = 0;  // number of changes made in `now_`
};

// Second run of a recording's hand.
struct Rerun {
  RerunRows run;
  History history;                   // of both runs
  std::vector<std::string> changes;  // of settings, as "coupling.eta=0.5"
};

// Loads a session; slow, as all below: not for the window's thread. Errors of all: FileError and
// the like.
LoadedSession load_session(const std::filesystem::path& file);
// Runs the shipped story into the file `out`, which is replaced; returns nothing if cancelled.
std::optional<LoadedSession> load_story(const std::filesystem::path& out, TaskProgress& progress);
// Runs a hand's path in this world into the file `out`, which is replaced; returns nothing if
// cancelled.
std::optional<LoadedSession> load_hand(const std::filesystem::path& hand, RunPlan world,
                                       const std::filesystem::path& out, TaskProgress& progress);
// Runs the session's hand again under `chosen` for all settings that may change. Returns no rows if
// cancelled.
Rerun run_again(const Session& session, const std::string& where, const Parameters& chosen,
                TaskProgress& progress);

class PlayedSession {
 public:
  // Needs a current OpenGL context. Errors: as Stage.
  explicit PlayedSession(LoadedSession loaded);

  const std::filesystem::path& file() const { return file_; }
  const SceneDocument& document() const { return document_; }
  Player& player() { return player_; }
  const Player& player() const { return player_; }
  Stage& stage() { return *stage_; }
  const Stage& stage() const { return *stage_; }

  // Returns the story's step at the player's time; null: it is no story.
  const StoryStep* step() const;
  const std::vector<StoryStep>& steps() const { return steps_; }
  // Returns the names of all runs in a step of the story.
  RunNames names_in(const StoryStep& step) const;

  // Returns the names and laws of all runs at the player's time; nothing for a story, or beside a
  // re-run.
  std::optional<RunNames> names_now();

  // Returns the row of the hardest contact, for the session's thumbnail.
  std::size_t row_to_show() const;

  // Facts on the recording, for example its place in a sweep; may be empty.
  const std::vector<Fact>& facts() const { return facts_; }
  const std::vector<Fact>& verdict() const { return verdict_; }
  // Returns the settings at the player's time of the first lane, and of all lanes.
  const Parameters& settings() { return lanes_[kMainLane].at(player_.index()); }
  const Parameters& began_with() const { return lanes_[kMainLane].began(); }  // first lane
  std::vector<Parameters> lane_settings();

  // Returns the users' marks in the order of their ticks; show() replaces them without writing
  // them.
  const std::vector<Mark>& marks() const { return marks_; }
  void show(std::vector<Mark> marks);
  double time_of(const Mark& mark) const;  // on the player's time axis [s]

  // Shows a re-run beside the recording. Errors: as Stage.
  void show(Rerun again);
  bool has_rerun() const { return !rerun_.empty(); }
  // Returns the settings that the re-run changed, as "coupling.eta=0.5".
  const std::vector<std::string>& changes_of_rerun() const { return changes_of_rerun_; }
  // Returns the figures of the recording and of the last re-runs, the newest last; empty before the
  // first one.
  const std::vector<RunFigures>& tried() const { return tried_; }
  // Returns the re-run's row at the player's time; empty without one.
  std::span<const double> rerun_row() const;
  // Returns the rows of all lanes at the player's time; the first one's alone beside a re-run.
  std::vector<std::span<const double>> rows() const;

 private:
  std::unique_ptr<Stage> make_stage(History history) const;

  std::filesystem::path file_;
  Player player_;
  ArmDescription arm_;
  SceneDocument document_;
  MeshModels models_;
  std::vector<StoryStep> steps_;
  std::vector<Fact> facts_, verdict_;
  std::vector<Mark> marks_;
  std::vector<RecordedSettings> lanes_;
  LargeVector<double> rerun_;  // rows of the re-run; may be empty
  std::vector<std::string> changes_of_rerun_;
  std::vector<RunFigures> tried_;
  std::unique_ptr<Stage> stage_;
};

}  // namespace limpid
