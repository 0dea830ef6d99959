#include "app/desktop/live/live_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "app/device/device_store.h"
#include "app/run/replay.h"
#include "core/dynamics/arm.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kDrainRows = 512;

}  // namespace

LiveSession::~LiveSession() {
  loop_.close();
  try {
    complete_recording();
  } catch (const std::exception& e) {
    std::fputs(fmt::format("limpid: {}\n", e.what()).c_str(), stderr);  // the terminal may be gone
  }
  for (std::future<PlotNotice>& saving : saving_) {
    if (const PlotNotice notice = saving.get(); notice.bad) {
      std::fputs(fmt::format("limpid: {}\n", notice.text).c_str(), stderr);
    }
  }
}

void LiveSession::complete_recording() {
  if (opening_.valid()) {  // no row was recorded
    const std::unique_ptr<Recorder> empty = opening_.get();
    empty->finish();
    fs::remove(empty->out());
  }
  loop_.finish_recording();
  if (closing_.valid()) closing_.get();
}

void LiveSession::open(ArmDescription arm, SceneDocument document, const MeshModels& models,
                       const Parameters& p, double shown, std::unique_ptr<Device> device) {
  auto fresh = make_stage(std::move(arm), std::move(document), models, p, shown);
  const Vec3 rest = rest_tip(fresh->arm());
  if (device) {
    loop_.open(fresh->arm(), fresh->document().scene, p, std::move(device));
  } else {
    loop_.open(fresh->arm(), fresh->document().scene, p, rest);
  }
  controls_.grab = controls_.magnet = controls_.paused = false;
  controls_.pull = {};
  controls_.slow = 1;
  controls_.goal = rest;
  take_stage(std::move(fresh));
}

void LiveSession::open_beside(SceneDocument document, const MeshModels& models, const Parameters& p,
                              double shown) {
  if (const int bodies = count_bodies(document.scene); bodies != loop_.layout().bodies()) {
    throw std::runtime_error(fmt::format(
        "This scene has {} objects that move, the one under way {}: unplug the device first.",
        bodies, loop_.layout().bodies()));
  }
  auto fresh = make_stage(stage_->arm(), std::move(document), models, p, shown);
  touch(fresh->document().scene);
  take_stage(std::move(fresh));
}

void LiveSession::touch(const Scene& scene) {
  controls_.pull = {};  // bodies may have other numbers
  loop_.exchange(std::make_unique<TouchWorlds>(stage_->arm(), scene));
}

std::unique_ptr<Stage> LiveSession::make_stage(ArmDescription arm, SceneDocument document,
                                               const MeshModels& models, const Parameters& p,
                                               double shown) const {
  const int channels = TraceChannels(row_layout(arm.dof(), document.scene)).count();
  return std::make_unique<Stage>(std::move(arm), std::move(document), models,
                                 History({.channels = 2 * channels, .tick = p.tick}), shown);
}

void LiveSession::take_stage(std::unique_ptr<Stage> fresh) {
  stage_ = std::move(fresh);
  rows_.assign(2 * kDrainRows * static_cast<std::size_t>(loop_.layout().stride()), 0.0);
}

void LiveSession::drop_pictures() {
  loop_.close();
  stage_.reset();
}

std::span<const double> LiveSession::row() const {
  return std::span(loop_.snapshot().row).first(static_cast<std::size_t>(loop_.layout().stride()));
}

std::string LiveSession::why_time_is_fixed() const {
  return loop_.device_in_place()
             ? "A real device is in the arm's place: its time cannot be stopped."
             : "";
}

std::string LiveSession::pace_text() const {
  if (paused()) return "paused";
  if (!why_time_is_fixed().empty() || controls_.slow == 1) return "";
  return fmt::format("1/{} speed", controls_.slow);
}

std::string LiveSession::why_no_magnet() const {
  const auto& objects = stage_->document().scene.objects;
  return std::ranges::any_of(objects, [](const Object& o) { return o.body && o.body->magnet; })
             ? ""
             : "Nothing in this scene can be picked up.";
}

void LiveSession::toggle_magnet() {
  controls_.magnet = !controls_.magnet && why_no_magnet().empty();
  notices_.say(controls_.magnet ? "The magnet is on: what the tip touches hangs on it. H lets go."
                                : "The magnet is off.");
}

void LiveSession::start_over() {
  if (recording()) {
    notices_.say("Stop the recording before starting over.", true);
    return;
  }
  controls_.grab = controls_.magnet = false;
  controls_.pull = {};
  ++controls_.resets;
  const bool off = loop_.device_in_place() || !force_armed();
  notices_.say(off ? "Started over, at rest and without force; F arms it."
                   : "Started over, at rest.");
}

void LiveSession::let_go(std::unique_ptr<Device> device) {
  device_tasks_.run(
      [done = std::shared_ptr<Device>(std::move(device))]() mutable { done.reset(); });
}

std::span<const double> LiveSession::twin_row() const {
  if (!controls_.twin || loop_.device_in_place()) return {};
  const auto row =
      std::span(loop_.snapshot().twin).first(static_cast<std::size_t>(loop_.layout().stride()));
  return std::isnan(row[0]) ? std::span<const double>() : row;
}

std::string LiveSession::why_twin_is_fixed() const {
  if (recording()) return "Stop the recording before the twin comes or goes.";
  if (loop_.device_in_place()) {
    return "A twin needs the virtual arm: one hand cannot hold two real devices.";
  }
  return {};
}

void LiveSession::update(const Parameters& p, const Parameters* twin) {
  controls_.parameters = p;
  controls_.twin = twin != nullptr;
  if (twin != nullptr) controls_.twin_parameters = *twin;
  loop_.set(controls_);
  loop_.update();
  follow_recording();
  follow_saving();
  stage_->follow(p);
  take_rows();
  set_marks();
  stage_->follow_energy(stage_->history.end());
  watch_loop();
}

void LiveSession::mark(const std::string& label, const std::string& key) {
  changes_.push_back({0, key, label});
}

LiveSession::Moment LiveSession::now() const {
  Moment at{.time = stage_->history.end_time()};
  if (!loop_.recording()) return at;
  at.row = loop_.recorder()->newest();
  at.recording = loop_.recorder();
  return at;
}

void LiveSession::note(const Moment& at, const std::string& text) {
  if (at.row && loop_.recording() && loop_.recorder() == at.recording) {
    loop_.mark({*at.row, text});
  } else if (at.row) {
    notices_.say("The recording that it was to be kept with has ended: the mark is in the plots.");
  }
  if (stage_->history.marks().size() == History::kMostMarks) {
    notices_.say_once(fmt::format("The plots show the newest {} marks only; a recording keeps all.",
                                  History::kMostMarks),
                      false);
  }
  stage_->history.mark_at(at.time, text, kNoteMark);
}

// Sets marks after the rows of before the change: however long a frame takes, a mark stands at its
// change.
void LiveSession::set_marks() {
  History& history = stage_->history;
  for (PlotMark& change : changes_) {
    history.mark(history.end_time() - history.offset(), std::move(change.label),
                 std::move(change.key));
  }
  changes_.clear();
}

void LiveSession::take_rows() {
  const auto stride = static_cast<std::size_t>(loop_.layout().stride());
  while (const std::size_t count = loop_.drain(rows_)) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto both = std::span<const double>(rows_).subspan(2 * i * stride, 2 * stride);
      stage_->append(both.first(stride), both.subspan(stride));
      if (on_row) on_row(both.first(stride), both.subspan(stride), loop_.drained_from() + i);
    }
  }
}

void LiveSession::watch_loop() {
  const LoopStatus loop = loop_.status();
  if (was_running_ && !loop.running) {
    notices_.say(
        fmt::format("The loop has stopped, without force: {}. Start Limpid again.", loop.failure),
        true);
  }
  was_running_ = loop.running;
}

bool LiveSession::became_unstable() {
  const bool diverged = loop_.snapshot().diverged;
  return !std::exchange(was_diverged_, diverged) && diverged;
}

bool LiveSession::may_record() {
  if (opening_.valid()) return false;
  if (closing_.valid()) notices_.say("The last recording is still being closed.");
  return !closing_.valid();
}

void LiveSession::record(const RunPlan& plan, const fs::path& file, bool replaces) {
  last_ = {.file = file};
  SessionInfo about = session_info(plan);
  if (loop_.device_in_place()) about.safety = limits_text(controls_.limits);
  opening_ = file_tasks_.run(
      [file, replaces, info = std::move(about), initial = plan.parameters, twin = plan.beside] {
        return std::make_unique<Recorder>(file, info, initial, replaces, Recorder::kLiveRoom,
                                          twin.empty() ? nullptr : &twin[0].parameters);
      });
}

void LiveSession::follow_recording() {
  try {
    if (auto recorder = take_ready(opening_)) {
      if (const std::string note = lock_note(**recorder); !note.empty()) notices_.say(note);
      loop_.record(std::move(*recorder));
      mark("recording", "rec");
    }
    if (loop_.recording() && loop_.recorder()->failed()) {
      last_.trouble = why_it_ended(*loop_.recorder());
      loop_.stop_recording();
    }
    if (std::shared_ptr<Recorder> done = loop_.take_recorded()) {
      recorded_ = done->out();
      last_ = {done->out(), done->rows(), done->dropped(), false, std::move(last_.trouble)};
      closing_ = file_tasks_.run([done] {
        done->finish();
        const std::uint64_t dropped = done->dropped();
        const std::string missing = dropped > 0 ? fmt::format(", {} ticks missing", dropped) : "";
        return Notice{
            fmt::format("Recorded {}{}. Play it with P.", done->out().filename().string(), missing),
            dropped > 0};
      });
    }
    if (auto notice = take_ready(closing_)) {
      last_.complete = true;
      notices_.say(notice->text, notice->bad);
    }
  } catch (const std::exception& e) {
    notices_.say(e.what(), true);
  }
}

void LiveSession::save_beside(std::function<PlotNotice()> work) {
  saving_.push_back(file_tasks_.run(std::move(work)));
}

void LiveSession::follow_saving() {
  for (std::future<PlotNotice>& saving : saving_) {
    const auto notice = take_ready(saving);
    if (!notice) continue;
    if (!notice->file.empty()) written_ = notice->file;
    if (!notice->text.empty()) notices_.say(notice->text, notice->bad);
  }
  std::erase_if(saving_, [](const std::future<PlotNotice>& saving) { return !saving.valid(); });
}

}  // namespace limpid
