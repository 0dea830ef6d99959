// Recordings that are looked at: loading one, its second run, and writing it as a table.
#pragma once

#include <optional>
#include <utility>

#include "app/desktop/base/notices.h"
#include "app/desktop/playback/film_process.h"
#include "app/desktop/playback/played_session.h"

namespace limpid {

class Playback {
 public:
  explicit Playback(Notices& notices) : notices_(notices) {}

  // The session comes in beside the window and is shown then.
  void open(const std::filesystem::path& file);
  // The story that comes along, run anew.
  void open_story();
  // A hand's path through this world (all of a plan but the hand), run beside the window.
  void run_hand(const std::filesystem::path& file, RunPlan world);
  // What some other work makes; nothing where that was cancelled.
  using Load = Task<std::optional<LoadedSession>>::Work;
  void load(std::string what, Load work) { loading_.start(std::move(what), std::move(work)); }
  bool loading() const { return loading_.busy(); }
  double loading_part() const { return loading_.part(); }  // 0 to 1; 0 of what does not tell
  void cancel_loading() { loading_.ask_to_stop(); }
  const std::string& what() const { return loading_.what(); }  // for people, while loading
  void close();
  // The same of a story that somebody takes over: it goes on here when it is opened again.
  void take_over();

  // The session that is shown; null: none is, the loop is.
  PlayedSession* shown() { return shown_ ? &*shown_ : nullptr; }
  const PlayedSession* shown() const { return shown_ ? &*shown_ : nullptr; }
  bool on() const { return shown_.has_value(); }

  void toggle_playing();  // precondition: on()
  // The recorded hand under these settings.
  void start_rerun(const Parameters& chosen);
  void cancel_rerun() { rerunning_.cancel(); }
  bool rerunning() const { return rerunning_.busy(); }
  double rerun_part() const { return rerunning_.part(); }  // 0 to 1
  // The table goes beside the session's file.
  void export_csv();
  bool exporting() const { return exporting_.busy(); }

  // Made as `limpid play --video` does, beside the session's file, or, where nothing can be
  // written, among the user's own sessions.
  void export_video(const VideoRequest& order);
  const Task<std::string>& video() const { return filming_; }  // while it is made
  void cancel_video() { filming_.ask_to_stop(); }
  // The video or table that was written last, once; empty: none.
  std::filesystem::path take_written() { return std::exchange(written_, {}); }

  // What there was last to look at; empty: nothing yet.
  const std::filesystem::path& last() const { return last_; }
  void set_last(const std::filesystem::path& file) { last_ = file; }
  // Makes sessions of the recordings in a folder that were cut off.
  void recover_leftovers(const std::filesystem::path& folder);

  // Once a frame. True when another session has come.
  bool update(double dt);
  // Before the OpenGL context goes.
  void drop_pictures() { shown_.reset(); }

 private:
  bool take_results();

  Notices& notices_;
  std::optional<PlayedSession> shown_;
  std::filesystem::path table_, film_, written_;
  std::filesystem::path last_, left_;  // left_: a story, at
  double left_at_ = 0;                 // [s]
  bool told_of_build_ = false;         // that another build made the session that is shown
  Task<std::optional<LoadedSession>> loading_;
  Task<Rerun> rerunning_;
  Task<std::string> exporting_, filming_;
};

}  // namespace limpid
