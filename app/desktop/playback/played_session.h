// A session that is being looked at, with a second run of its hand beside it if one was made.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/base/tasks.h"
#include "app/desktop/base/stage.h"
#include "app/desktop/playback/player.h"
#include "app/run/simulate.h"
#include "app/story/story.h"

namespace limpid {

// A line of what is known of a recording.
struct Fact {
  std::string name, value;
};

// A session as it comes from its file.
struct LoadedSession {
  std::filesystem::path file;
  std::shared_ptr<const Session> session;
  ArmDescription arm;
  SceneDocument document;
  MeshModels models;
  History history;
  std::vector<StoryStep> steps = {};  // of the story that it tells; none: it is no story
  std::string said = {};              // to be told once it is shown; empty: nothing
  bool bad = false;                   // what is said is something wrong
  std::vector<Fact> facts = {};       // what it is a recording of, beside its settings
  std::vector<Fact> verdict = {};     // what was measured of it
};

// The settings of one of a recording's runs, as they were at a row.
class RecordedSettings {
 public:
  // Errors: FileError, where the session says something else than settings.
  RecordedSettings(const Session& session, const std::string& where);

  const Parameters& at(std::size_t row);

 private:
  const Session& session_;
  Parameters began_, now_;
  std::size_t made_ = 0;  // changes in `now_`
};

// A second run of a recording's hand.
struct Rerun {
  LargeVector<double> rows;  // as many as the session's
  RunEnd end;                // where it diverged the last row stands for those that are missing
  History history;           // of both
  std::string note;          // why it may come out otherwise than recorded; for people
};

// Neither is for the window's thread. Errors: FileError and the like.
LoadedSession load_session(const std::filesystem::path& file);
// Runs the story that comes along and leaves it in `out`, which is replaced; nothing if it was
// cancelled.
std::optional<LoadedSession> load_story(const std::filesystem::path& out, TaskProgress& progress);
// Runs the path of a hand in this world and leaves it in `out`, which is replaced; nothing if it
// was cancelled.
std::optional<LoadedSession> load_hand(const std::filesystem::path& hand, RunPlan world,
                                       const std::filesystem::path& out, TaskProgress& progress);
// Under `chosen`, where these may be changed; without rows if it was cancelled.
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

  // Of the story that is told, at the player's time; null: it is no story.
  const StoryStep* step() const;
  const std::vector<StoryStep>& steps() const { return steps_; }
  // What the plots call the two runs in a step of it.
  RunNames names_in(const StoryStep& step) const;

  // The same at the player's time, where no story has names of its own; nothing of one run, or
  // beside a re-run.
  std::optional<RunNames> names_now();

  // Where it is pressed hardest: what its small picture shows.
  std::size_t row_to_show() const;

  // Which run of a sweep it is, say; or nothing.
  const std::vector<Fact>& facts() const { return facts_; }
  const std::vector<Fact>& verdict() const { return verdict_; }
  // Its settings at the player's time, and the second run's; null: it has one run.
  const Parameters& settings() { return first_.at(player_.index()); }
  const Parameters* twin_settings() { return second_ ? &second_->at(player_.index()) : nullptr; }

  // What people noted, in the order of their ticks; these are shown from now on, nothing is
  // written.
  const std::vector<Mark>& marks() const { return marks_; }
  void show(std::vector<Mark> marks);
  double time_of(const Mark& mark) const;  // as the player counts it [s]

  // From now on beside the recording. Errors: as Stage.
  void show(Rerun again);
  bool has_rerun() const { return !rerun_.empty(); }
  // The second run's at the player's time; empty without one.
  std::span<const double> rerun_row() const;
  // The twin's at the player's time; empty for a session of one run, and while there is a re-run.
  std::span<const double> twin_row() const;

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
  RecordedSettings first_;
  std::optional<RecordedSettings> second_;
  LargeVector<double> rerun_;  // rows of the second run; or none
  std::unique_ptr<Stage> stage_;
};

}  // namespace limpid
