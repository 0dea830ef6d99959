#include "app/desktop/playback/played_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "app/story/run_story.h"
#include "app/style/words.h"
#include "devices/files/session/hand_file.h"
#include "devices/files/text_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr double kOfStory = 12;  // time that the plots of a story show: about a step [s]

// Returns the settings of a recorded lane.
std::vector<SettingsFrom> settings_of(const Session& lane, const std::string& where) {
  std::vector<SettingsFrom> all{{0, session_parameters(lane, where)}};
  for (const SettingChange& change : lane.changes) {
    all.push_back({change.row, all.back().parameters});
    apply_change(all.back().parameters, change);
  }
  return all;
}

// Returns the history of the whole recording, and of runs beside it with these settings. It marks a
// story's steps, or else every change of a setting.
History history_of(const Session& session, const std::string& where, const ArmDescription& arm,
                   LaneRows beside, std::span<const std::vector<SettingsFrom>> settings,
                   const std::vector<StoryStep>& steps) {
  TraceChannels channels(arm, session.layout, session.info.bodies);
  Parameters p = session_parameters(session, where);
  channels.set_limits(motor_limits(arm, p));
  std::vector<std::size_t> next(settings.size(), 0);
  const double length = static_cast<double>(session.size()) * session.info.tick;
  History history({.channels = channels.count() * (1 + static_cast<int>(beside.size())),
                   .seconds = length + 1,
                   .tick = session.info.tick});
  const auto stride = static_cast<std::size_t>(session.layout.stride());
  ForgetBehind forget;
  auto change = session.changes.begin();
  for (std::size_t k = 0; k < session.size(); ++k) {
    for (; change != session.changes.end() && change->row <= k; ++change) {
      apply_change(p, *change);
      channels.set_limits(motor_limits(arm, p));
      const ParameterInfo* info = find_parameter(change->key());
      if (info == nullptr || !steps.empty()) continue;
      history.mark(static_cast<double>(k) * session.info.tick, mark_text(*info, p), info->key);
    }
    for (std::size_t i = 0; i < settings.size(); ++i) {
      for (; next[i] < settings[i].size() && settings[i][next[i]].row <= k; ++next[i]) {
        channels.set_limits(motor_limits(arm, settings[i][next[i]].parameters), i + 1);
      }
    }
    for (const StoryStep& step : steps) {
      const double at = std::round(step.begins / session.info.tick);
      if (at == static_cast<double>(k) && !step.mark.empty()) history.mark(step.begins, step.mark);
    }
    std::vector<std::span<const double>> rows{session.row(k)};
    for (const auto& run : beside) rows.push_back(run.subspan(k * stride, stride));
    channels.append(history, rows);
    forget.passed(rows.size() * stride * sizeof(double));
  }
  forget_large_blocks();
  return history;
}

}  // namespace

LoadedSession load_session(const fs::path& file) {
  auto session = std::make_shared<const Session>(read_session(file));
  if (session->size() == 0) throw FileError(file.string() + ": the recording has no rows");
  RunPlan world = replay(*session, file.string(), {});
  const auto lanes = session->lane_rows();
  std::vector<StoryStep> steps = told_in(*session, file).steps;
  std::vector<std::vector<SettingsFrom>> beside;
  for (std::size_t i = 1; i < session->lanes(); ++i) {
    beside.push_back(settings_of(session->lane(i), file.string()));
  }
  History history =
      history_of(*session, file.string(), world.arm, LaneRows(lanes).subspan(1), beside, steps);
  return {.file = file,
          .session = std::move(session),
          .arm = std::move(world.arm),
          .document = std::move(world.document),
          .models = std::move(world.models),
          .history = std::move(history),
          .steps = std::move(steps)};
}

std::optional<LoadedSession> load_story(const fs::path& out, TaskProgress& progress) {
  const Story story = read_story(default_story());
  const StoryRun run = run_story(
      story, progress.cancel, [&](double seconds) { progress.part = seconds / story.seconds(); });
  if (run.end.stopped) return std::nullopt;
  fs::create_directories(out.parent_path());
  write_session(run.session, {story.title, story.steps}, out, true);
  return load_session(out);
}

std::optional<LoadedSession> load_hand(const fs::path& hand, RunPlan world, const fs::path& out,
                                       TaskProgress& progress) {
  world.hand = read_hand(hand);
  world.rows =
      static_cast<std::uint64_t>(std::llround(world.hand.duration() / world.parameters.tick));
  fs::create_directories(out.parent_path());
  Recorder recorder(out, session_info(world), world.parameters, true, Recorder::kWaitingRoom);
  RunEnd end;
  try {
    end = simulate(world, {.realtime = false, .stop = &progress.cancel},
                   [&](std::span<const double> row, LaneChanges) {
                     progress.part =
                         static_cast<double>(recorder.rows()) / static_cast<double>(world.rows);
                     return recorder.push_waiting(row);
                   });
  } catch (const std::invalid_argument& e) {
    throw FileError(fmt::format("{}: {}", hand.string(), e.what()));
  }
  recorder.finish();
  return progress.cancel ? std::nullopt : std::optional(load_session(out));
}

Rerun run_again(const Session& session, const std::string& where, const Parameters& chosen,
                TaskProgress& progress) {
  RerunRows again = run_once_more(session, where, chosen, progress.cancel,
                                  [&](double part) { progress.part = part; });
  const std::span<const double> rows(again.rows);
  const LaneRows beside = again.rows.empty() ? LaneRows() : LaneRows(&rows, 1);
  History history =
      history_of(session, where, again.arm, beside, std::span(&again.settings, 1), {});
  return {std::move(again), std::move(history), changed_settings(session, where, chosen)};
}

RecordedSettings::RecordedSettings(const Session& session, const std::string& where)
    : session_(&session), began_(session_parameters(session, where)), now_(began_) {}

const Parameters& RecordedSettings::at(std::size_t row) {
  const std::vector<SettingChange>& changes = session_->changes;
  if (made_ > 0 && changes[made_ - 1].row > row) {
    made_ = 0;
    now_ = began_;
  }
  for (; made_ < changes.size() && changes[made_].row <= row; ++made_) {
    apply_change(now_, changes[made_]);
  }
  return now_;
}

PlayedSession::PlayedSession(LoadedSession loaded)
    : file_(std::move(loaded.file)),
      player_(std::move(loaded.session)),
      arm_(std::move(loaded.arm)),
      document_(std::move(loaded.document)),
      models_(std::move(loaded.models)),
      steps_(std::move(loaded.steps)),
      facts_(std::move(loaded.facts)),
      verdict_(std::move(loaded.verdict)),
      stage_(make_stage(std::move(loaded.history))) {
  for (std::size_t i = 0; i < player_.session().lanes(); ++i) {
    lanes_.emplace_back(player_.session().lane(i), file_.string());
  }
  if (const auto names = names_now()) stage_->name_runs(*names);
  show(player_.session().marks);
}

std::unique_ptr<Stage> PlayedSession::make_stage(History history) const {
  auto stage = std::make_unique<Stage>(arm_, document_, models_, std::move(history),
                                       steps_.empty() ? player_.duration() : kOfStory);
  stage->follow(session_parameters(player_.session(), file_.string()));
  return stage;
}

void PlayedSession::show(Rerun again) {
  stage_ = make_stage(std::move(again.history));
  const RowLayout& layout = player_.session().layout;
  const std::span<const double> rows(again.run.rows);
  RunNames names{{again.run.recorded, again.run.name}, false};
  if (!rows.empty()) {
    const auto first = rows.first(static_cast<std::size_t>(layout.stride()));
    names.laws = {laws_at(player_.session(), 0).front(),
                  static_cast<int>(layout.in(first, Column::kind)[0])};
  }
  stage_->name_runs(names);
  if (!rows.empty()) {
    constexpr std::size_t kMostTried = 8;
    if (tried_.empty()) tried_.push_back(again.run.recorded_figures);
    if (tried_.size() == kMostTried) tried_.erase(tried_.begin() + 1);
    tried_.push_back(again.run.figures);
  }
  rerun_ = std::move(again.run.rows);
  changes_of_rerun_ = std::move(again.changes);
  show(std::move(marks_));
}

double PlayedSession::time_of(const Mark& mark) const {
  return static_cast<double>(mark.tick) * player_.session().info.tick;
}

void PlayedSession::show(std::vector<Mark> marks) {
  marks_ = std::move(marks);
  std::ranges::stable_sort(marks_, {}, &Mark::tick);
  std::vector<PlotMark> lines;
  for (const Mark& mark : marks_) lines.push_back({time_of(mark), kNoteMark, mark.text});
  stage_->history.replace_marks(kNoteMark, lines);
}

std::size_t PlayedSession::row_to_show() const {
  const Session& session = player_.session();
  std::size_t hardest = 0;
  double most = 0;
  for (std::size_t k = 0; k < session.size(); ++k) {
    double torque = 0;
    for (const double f : session.at(k, Column::contact_torque)) torque += f * f;
    if (torque <= most) continue;
    most = torque;
    hardest = k;
  }
  forget_large_blocks();
  return hardest;
}

const StoryStep* PlayedSession::step() const {
  return steps_.empty() ? nullptr : &step_at(steps_, player_.time());
}

RunNames PlayedSession::names_in(const StoryStep& step) const {
  RunNames names{step.names, true, laws_at(player_.session(), step.begins)};
  names.names.resize(std::min(names.names.size(), player_.session().lanes()));
  return names;
}

std::optional<RunNames> PlayedSession::names_now() {
  if (has_rerun() || !steps_.empty()) return std::nullopt;
  return run_names(lane_settings());
}

std::vector<Parameters> PlayedSession::lane_settings() {
  std::vector<Parameters> all;
  for (RecordedSettings& lane : lanes_) all.push_back(lane.at(player_.index()));
  return all;
}

std::vector<std::span<const double>> PlayedSession::rows() const {
  const Session& session = player_.session();
  const bool shown = step() == nullptr || step()->beside;
  std::vector<std::span<const double>> rows;
  for (std::size_t i = 0; i < (shown && !has_rerun() ? session.lanes() : 1); ++i) {
    rows.push_back(session.lane(i).row(player_.index()));
  }
  return rows;
}

std::span<const double> PlayedSession::rerun_row() const {
  const auto stride = static_cast<std::size_t>(player_.session().layout.stride());
  return rerun_.empty() ? std::span<const double>()
                        : std::span<const double>(rerun_).subspan(player_.index() * stride, stride);
}

}  // namespace limpid
