// Playback of recordings: loading one, running its hand again, and writing it as a table or video.
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

  // Loads a session beside the window, then shows it.
  void open(const std::filesystem::path& file);
  // Runs the shipped story anew.
  void open_story();
  // Runs a hand's path through this world (a plan's all but the hand) beside the window.
  void run_hand(const std::filesystem::path& file, RunPlan world);
  // Work that makes a session; nothing if it was cancelled.
  using Load = Task<std::optional<LoadedSession>>::Work;
  void load(std::string what, Load work) { loading_.start(std::move(what), std::move(work)); }
  bool loading() const { return loading_.busy(); }
  double loading_part() const { return loading_.part(); }  // 0 to 1; 0 if the work does not tell
  void cancel_loading() { loading_.ask_to_stop(); }
  const std::string& what() const { return loading_.what(); }  // for people, while loading
  void close();
  // Closes a story that the user takes over: it goes on at the same time when it is opened again.
  void take_over();

  // Returns the session shown; null: the loop is shown.
  PlayedSession* shown() { return shown_ ? &*shown_ : nullptr; }
  const PlayedSession* shown() const { return shown_ ? &*shown_ : nullptr; }
  bool on() const { return shown_.has_value(); }

  void toggle_playing();  // precondition: on()
  // Runs the recorded hand under these settings.
  void start_rerun(const Parameters& chosen);
  void cancel_rerun() { rerunning_.cancel(); }
  bool rerunning() const { return rerunning_.busy(); }
  double rerun_part() const { return rerunning_.part(); }  // 0 to 1
  // Writes the table beside the session's file.
  void export_csv();
  bool exporting() const { return exporting_.busy(); }

  // Makes a video as `limpid play --video` does: beside the session's file or, if that folder
  // cannot be written, among the user's sessions.
  void export_video(const VideoRequest& order);
  const Task<std::string>& video() const { return filming_; }  // while it is made
  void cancel_video() { filming_.ask_to_stop(); }
  // Returns the last video or table written, once; empty: none.
  std::filesystem::path take_written() { return std::exchange(written_, {}); }

  // Returns the file of the last recording; empty: none yet.
  const std::filesystem::path& last() const { return last_; }
  void set_last(const std::filesystem::path& file) { last_ = file; }
  // Makes sessions of the recordings in a folder that were cut off.
  void recover_leftovers(const std::filesystem::path& folder);
  // The last of them in words, until a session is played or it is forgotten.
  const std::string& recovered() const { return recovered_; }
  void forget_recovered() { recovered_.clear(); }

  // Does the work of a frame; to be called once a frame. Returns true when another session has
  // come.
  bool update(double dt);
  // Drops all pictures; to be called before the OpenGL context goes.
  void drop_pictures() { shown_.reset(); }

 private:
  bool take_results();

  Notices& notices_;
  std::optional<PlayedSession> shown_;
  std::filesystem::path table_, film_, written_;
  std::string recovered_;
  std::filesystem::path last_, left_;  // left_: a story that the user took over
  double left_at_ = 0;                 // time in that story [s]
  bool told_of_build_ = false;         // the notice that another build made the session was shown
  Task<std::optional<LoadedSession>> loading_;
  Task<Rerun> rerunning_;
  Task<std::string> exporting_, filming_;
};

}  // namespace limpid
