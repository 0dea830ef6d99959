// The workbench's actions on recordings.
#include <fmt/format.h>

#include <algorithm>

#include "app/base/assets.h"
#include "app/desktop/workbench.h"
#include "app/run/replay.h"
#include "core/dynamics/arm.h"
#include "devices/files/config/config_file.h"
#include "devices/files/session/session_csv.h"

namespace limpid {

namespace fs = std::filesystem;

namespace {

// The plots hold the whole recording, and the re-run if there is one.
History history_of(const Session& session, std::span<const double> again) {
  const TraceChannels channels(session.layout);
  const double length = static_cast<double>(session.size()) * session.info.tick;
  History history({.channels = channels.count() * (again.empty() ? 1 : 2),
                   .seconds = length + 1,
                   .tick = session.info.tick});
  const auto stride = static_cast<std::size_t>(session.layout.stride());
  for (std::size_t k = 0; k < session.size(); ++k) {
    const auto second = again.empty() ? again : again.subspan(k * stride, stride);
    channels.append(history, session.row(k), second);
  }
  for (const SettingChange& change : session.changes) {
    std::string label = change.setting;
    std::erase(label, '"');
    history.mark(static_cast<double>(change.row) * session.info.tick, label);
  }
  return history;
}

Playback load_playback(const fs::path& file) {
  auto session = std::make_shared<const Session>(read_session(file));
  if (session->size() == 0) throw FileError(file.string() + ": holds no rows");
  RunPlan world = replay(*session, file.string(), {});
  return Playback{.file = file,
                  .player = Player(session),
                  .arm = std::move(world.arm),
                  .scene = std::move(world.scene),
                  .models = std::move(world.models),
                  .history = history_of(*session, {}),
                  .rerun = {},
                  .rerun_parameters = {},
                  .stage = nullptr};
}

Rerun run_again(const Session& session, const std::string& where, const Parameters& chosen,
                BackgroundProgress& progress) {
  const RunPlan plan = replay(session, where, chosen);
  std::vector<double> rows;
  rows.reserve(session.rows.size());
  std::uint64_t count = 0;
  const RunEnd end = simulate(plan, {.realtime = false, .stop = &progress.cancel},
                              [&](std::span<const double> row, const Parameters*) {
                                rows.insert(rows.end(), row.begin(), row.end());
                                progress.part =
                                    static_cast<double>(++count) / static_cast<double>(plan.rows);
                                return true;
                              });
  if (end.stopped || rows.empty()) return {{}, end, history_of(session, {})};
  const std::vector<double> last(rows.end() - session.layout.stride(), rows.end());
  while (rows.size() < session.rows.size()) rows.insert(rows.end(), last.begin(), last.end());
  History history = history_of(session, rows);
  return {std::move(rows), end, std::move(history)};
}

}  // namespace

void Workbench::open_session(const fs::path& file) {
  loading.start(
      fmt::format("loading {}", file.filename().string()),
      [file](BackgroundProgress&) -> std::optional<Playback> { return load_playback(file); });
}

void Workbench::toggle_playing() {
  if (playback) {
    playback->player.playing() ? playback->player.pause() : playback->player.play();
  } else if (!last_recording.empty()) {
    open_session(last_recording);
  } else {
    dialog = Dialog::open_session;
  }
}

void Workbench::close_playback() {
  rerunning.cancel();
  playback.reset();
}

// The recorded hand under the settings of the panels.
void Workbench::start_rerun() {
  if (!playback) return;
  playback->rerun_parameters = parameters;
  rerunning.start(
      "re-running",
      [session = playback->player.shared(), where = playback->file.string(), chosen = parameters](
          BackgroundProgress& progress) { return run_again(*session, where, chosen, progress); });
}

void Workbench::export_csv() {
  if (!playback || exporting.busy()) return;
  fs::path out = playback->file;
  out.replace_extension(".csv");
  exporting.start("writing the table",
                  [session = playback->player.shared(), out](BackgroundProgress&) {
                    write_csv(*session, out, false);
                    return fmt::format("Wrote {}", out.string());
                  });
}

void Workbench::recover_leftovers() {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(sessions_dir(), none)) {
    if (!entry.path().string().ends_with(".h5.part")) continue;
    try {
      const Recovered recovered = recover_session(entry.path(), false);
      say(fmt::format("Recovered {} ({} ticks) from a recording that was cut off.",
                      recovered.file.filename().string(), recovered.rows));
      last_recording = recovered.file;
    } catch (const std::exception& e) {
      say(e.what(), true);
    }
  }
}

void Workbench::take_results() {
  try {
    if (auto loaded = loading.take(); loaded && *loaded) {
      rerunning.cancel();
      playback.emplace(std::move(**loaded));
      last_recording = playback->file;
      const double length = playback->player.duration();
      playback->stage = std::make_unique<Stage>(playback->arm, playback->scene, playback->models,
                                                std::move(playback->history), length);
      camera.frame(playback->stage->picture.bounds());
      playback->player.play();
    }
    if (auto again = rerunning.take(); again && playback && !again->rows.empty()) {
      show_rerun(std::move(*again));
    }
    if (auto text = exporting.take()) say(*text);
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

void Workbench::show_rerun(Rerun again) {
  if (again.end.diverged) {
    say(fmt::format("The re-run is unstable from {:.3f} s on: {}. It is shown up to its end.",
                    again.end.diverged_at, again.end.why),
        true);
  }
  playback->rerun = std::move(again.rows);
  playback->stage = std::make_unique<Stage>(playback->arm, playback->scene, playback->models,
                                            std::move(again.history), playback->player.duration());
}

}  // namespace limpid
