#include "app/desktop/playback/playback.h"

#include <fmt/format.h>

#include <utility>

#include "app/base/folders.h"
#include "app/desktop/base/settings.h"
#include "app/desktop/playback/film_process.h"
#include "devices/files/session/session_csv.h"

namespace limpid {

namespace fs = std::filesystem;

namespace {

// The story is nobody's recording: it is neither listed among them, nor what P plays. Nor does P
// play a sweep's point, which has facts of its own.
fs::path story_file() { return user_data_dir() / "story/story.h5"; }

}  // namespace

void Playback::open(const fs::path& file) {
  loading_.start(
      fmt::format("loading {}", file.filename().string()),
      [file](TaskProgress&) -> std::optional<LoadedSession> { return load_session(file); });
}

void Playback::open_story() {
  left_.clear();
  loading_.start("running the story", [out = story_file()](TaskProgress& progress) {
    return load_story(out, progress);
  });
}

void Playback::run_hand(const fs::path& file, RunPlan world) {
  const fs::path out = sessions_dir() / fmt::format("hand-{}.h5", file.stem().string());
  loading_.start(fmt::format("running {}", file.filename().string()),
                 [file, out, world = std::move(world)](TaskProgress& progress) {
                   return load_hand(file, world, out, progress);
                 });
}

void Playback::close() {
  rerunning_.cancel();
  shown_.reset();
}

void Playback::take_over() {
  last_ = left_ = shown_->file();
  left_at_ = shown_->player().time();
  notices_.say("You move the arm now. P continues the story.");
  close();
}

void Playback::toggle_playing() {
  Player& player = shown_->player();
  player.playing() ? player.pause() : player.play();
}

void Playback::start_rerun(const Parameters& chosen) {
  if (!shown_) return;
  rerunning_.start("re-running", [session = shown_->player().shared(),
                                  where = shown_->file().string(), chosen](TaskProgress& progress) {
    return run_again(*session, where, chosen, progress);
  });
}

void Playback::export_csv() {
  if (!shown_ || exporting_.busy()) return;
  fs::path out = shown_->file();
  out.replace_extension(".csv");
  table_ = out;
  exporting_.start("writing the table", [session = shown_->player().shared(), out](TaskProgress&) {
    write_csv(*session, out, false);
    return fmt::format("Wrote {}", out.string());
  });
}

void Playback::export_video(const VideoRequest& order) {
  if (!shown_ || filming_.busy()) return;
  const fs::path session = shown_->file();
  const fs::path out = video_of(session, order.kind, sessions_dir());
  film_ = out;
  filming_.start(fmt::format("making {}", out.filename().string()),
                 [session, out, order](TaskProgress& progress) {
                   return film_beside(session, out, words_of(order), progress.cancel, progress.part)
                              ? fmt::format("Wrote {}", out.string())
                              : fmt::format("{} was not written.", out.filename().string());
                 });
}

void Playback::recover_leftovers(const fs::path& folder) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (!entry.path().string().ends_with(".h5.part")) continue;
    try {
      const Recovered recovered = recover_session(entry.path(), false);
      recovered_ = fmt::format("Recovered {} ({} ticks) from a recording that was interrupted.",
                               recovered.file.filename().string(), recovered.rows);
      last_ = recovered.file;
    } catch (const std::exception& e) {
      notices_.say(e.what(), true);
    }
  }
}

bool Playback::update(double dt) {
  bool opened = false;
  try {
    opened = take_results();
  } catch (const std::exception& e) {
    notices_.say(e.what(), true);
  }
  if (shown_) {
    shown_->player().advance(dt);
    Stage& stage = shown_->stage();
    stage.follow_energy(shown_->player().index() + 1);
  }
  return opened;
}

bool Playback::take_results() {
  bool opened = false;
  if (auto loaded = loading_.take(); loaded && *loaded) {
    rerunning_.cancel();
    if (!(*loaded)->said.empty()) notices_.say((*loaded)->said, (*loaded)->bad);
    const bool point = !(*loaded)->facts.empty();
    PlayedSession fresh(std::move(**loaded));
    shown_.emplace(std::move(fresh));
    told_of_build_ = false;
    recovered_.clear();
    if (shown_->file() != story_file() && !point) last_ = shown_->file();
    if (shown_->file() == std::exchange(left_, {})) shown_->player().seek(left_at_);
    shown_->player().play();
    opened = true;
  }
  if (auto again = rerunning_.take(); again && shown_ && !again->run.rows.empty()) {
    const RunEnd end = again->run.end;
    const double at_limit = again->run.at_limit;
    const std::vector<std::string> cautions = again->run.cautions;
    const std::string& note = again->run.note;
    if (!note.empty() && !std::exchange(told_of_build_, true)) notices_.say(note);
    shown_->show(std::move(*again));
    if (end.diverged) {
      notices_.say(
          fmt::format("The re-run is unstable from t = {:.3f} s on: {}. The whole re-run is shown.",
                      end.diverged_at, end.why),
          true);
    } else {
      for (const std::string& caution : cautions) notices_.say("Re-run: " + caution + ".", true);
    }
    if (constexpr double kTold = 0.02; !end.diverged && at_limit >= kTold) {  // [s]
      notices_.say(
          fmt::format("In the re-run motors are at their limit for {:.3g} s. In this time device "
                      "and proxy may drift apart under every law.",
                      at_limit));
    }
  }
  for (const auto& [work, file] : {std::pair(&exporting_, &table_), {&filming_, &film_}}) {
    const auto text = work->take();
    if (!text) continue;
    notices_.say(*text);
    if (std::error_code none; fs::exists(*file, none)) written_ = *file;
  }
  return opened;
}

}  // namespace limpid
