// The workbench's actions on recordings.
#include <fmt/format.h>

#include <algorithm>

#include "app/assets.h"
#include "app/desktop/workbench.h"
#include "app/run/replay.h"
#include "core/dynamics/arm.h"
#include "devices/files/config_file.h"
#include "devices/files/session_csv.h"

namespace limpid {

namespace fs = std::filesystem;

void Workbench::open_session(const fs::path& file) {
  loading.start(fmt::format("loading {}", file.filename().string()),
                [file](BackgroundProgress&) -> std::optional<Playback> {
                  Session session = read_session(file);
                  if (session.size() == 0) throw FileError(file.string() + ": holds no rows");
                  RunPlan world = replay(session, file.string(), {});
                  return Playback{.file = file,
                                  .player = Player(std::move(session)),
                                  .arm = std::move(world.arm),
                                  .scene = std::move(world.scene),
                                  .models = std::move(world.models),
                                  .rerun = {},
                                  .rerun_parameters = {},
                                  .stage = nullptr};
                });
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
  exporting.cancel();
  playback.reset();
}

// The recorded hand under the settings of the panels.
void Workbench::start_rerun() {
  if (!playback) return;
  playback->rerun_parameters = parameters;
  // The session stays where it is meanwhile: whoever takes it away ends the re-run first.
  rerunning.start(
      "re-running", [&session = playback->player.session(), where = playback->file.string(),
                     chosen = parameters](BackgroundProgress& progress) {
        const RunPlan plan = replay(session, where, chosen);
        std::vector<double> rows;
        rows.reserve(plan.rows * static_cast<std::size_t>(RowLayout(plan.arm.dof()).stride()));
        std::uint64_t count = 0;
        simulate(plan, {.realtime = false, .stop = &progress.cancel},
                 [&](std::span<const double> row, const Parameters*) {
                   rows.insert(rows.end(), row.begin(), row.end());
                   progress.part = static_cast<double>(++count) / static_cast<double>(plan.rows);
                   return true;
                 });
        return rows;
      });
}

void Workbench::export_csv() {
  if (!playback) return;
  fs::path out = playback->file;
  out.replace_extension(".csv");
  // The session stays where it is meanwhile: whoever takes it away waits for the end.
  exporting.start("writing the table",
                  [&session = playback->player.session(), out](BackgroundProgress&) {
                    write_csv(session, out, false);
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
      exporting.cancel();
      playback.emplace(std::move(**loaded));
      last_recording = playback->file;
      rebuild_playback_stage();
      camera.frame(playback->stage->picture.bounds());
      playback->player.play();
    }
    if (auto rows = rerunning.take(); rows && playback) {
      playback->rerun = std::move(*rows);
      const std::size_t wanted = playback->player.session().rows.size();
      if (playback->rerun.size() < wanted) {
        say("The re-run became unstable; it is shown up to there.", true);
        const auto stride = static_cast<std::size_t>(playback->player.session().layout.stride());
        while (!playback->rerun.empty() && playback->rerun.size() < wanted) {
          const std::size_t last = playback->rerun.size() - stride;
          playback->rerun.resize(playback->rerun.size() + stride);
          std::copy_n(playback->rerun.begin() + static_cast<std::ptrdiff_t>(last), stride,
                      playback->rerun.end() - static_cast<std::ptrdiff_t>(stride));
        }
      }
      rebuild_playback_stage();
    }
    if (auto text = exporting.take()) say(*text);
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

// The plots hold the whole recording, and the re-run if there is one.
void Workbench::rebuild_playback_stage() {
  const Session& session = playback->player.session();
  const double length = playback->player.duration();
  playback->stage = std::make_unique<Stage>(playback->arm, playback->scene, playback->models,
                                            StageOptions{.seconds = length + 1,
                                                         .tick = session.info.tick,
                                                         .shown = length,
                                                         .rerun = !playback->rerun.empty()});
  const auto stride = static_cast<std::size_t>(session.layout.stride());
  for (std::size_t k = 0; k < session.size(); ++k) {
    playback->stage->append(
        session.row(k), playback->rerun.empty()
                            ? std::span<const double>()
                            : std::span<const double>(playback->rerun).subspan(k * stride, stride));
  }
  for (const SettingChange& change : session.changes) {
    std::string label = change.setting;
    std::erase(label, '"');
    playback->stage->history.mark(static_cast<double>(change.row) * session.info.tick, label);
  }
}

}  // namespace limpid
