#include "app/desktop/live/live_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "app/device/device_store.h"
#include "app/run/replay.h"
#include "core/dynamics/arm.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

}  // namespace

LiveStage::LiveStage(Notices& notices, AskForPriority ask)
    : notices_(notices), session_(std::move(ask), [this](std::unique_ptr<Device> device) {
        let_go(std::move(device));
      }) {}

LiveStage::~LiveStage() {
  const auto say = [](const std::string& why) {
    std::fputs(fmt::format("limpid: {}\n", why).c_str(), stderr);  // the terminal may be gone
  };
  const auto attempt = [&say](auto&& work) {
    try {
      work();
    } catch (const std::exception& e) {
      say(e.what());
    }
  };
  loop().close();
  attempt([this] { session_.complete_recording(); });
  for (std::future<PlotNotice>& saving : saving_) {
    attempt([&] {
      if (const PlotNotice notice = saving.get(); notice.bad) say(notice.text);
    });
  }
}

void LiveStage::open(ArmDescription arm, SceneDocument document, const MeshModels& models,
                     const Parameters& p, double shown, std::unique_ptr<Device> device) {
  auto fresh = make_stage(std::move(arm), std::move(document), models, p, shown);
  const Vec3 rest = rest_tip(fresh->arm());
  grip_.forget();
  if (device) {
    session_.open(fresh->arm(), fresh->document().scene, p, std::move(device));
  } else {
    session_.open(fresh->arm(), fresh->document().scene, p, rest);
  }
  stage_ = std::move(fresh);
}

void LiveStage::open_beside(SceneDocument document, const MeshModels& models, const Parameters& p,
                            double shown) {
  if (const int bodies = count_bodies(document.scene); bodies != loop().layout().bodies()) {
    throw std::runtime_error(
        fmt::format("This scene has {} objects that move, but the present scene has {}. Choose the "
                    "virtual arm before you open this scene.",
                    bodies, loop().layout().bodies()));
  }
  auto fresh = make_stage(stage_->arm(), std::move(document), models, p, shown);
  touch(fresh->document().scene);
  stage_ = std::move(fresh);
}

void LiveStage::touch(const Scene& scene) { session_.touch(stage_->arm(), scene); }

std::unique_ptr<Stage> LiveStage::make_stage(ArmDescription arm, SceneDocument document,
                                             const MeshModels& models, const Parameters& p,
                                             double shown) const {
  const int channels = TraceChannels(row_layout(arm.dof(), document.scene)).count();
  return std::make_unique<Stage>(
      std::move(arm), std::move(document), models,
      History({.channels = static_cast<int>(kMostLanes) * channels, .tick = p.tick}), shown);
}

void LiveStage::drop_pictures() {
  loop().close();
  stage_.reset();
}

std::string LiveStage::why_time_is_fixed() const {
  return loop().device_in_place() ? "A real device is used instead of the virtual arm. The "
                                    "simulation cannot be paused with a real device."
                                  : "";
}

std::string LiveStage::pace_text() const {
  if (paused()) return "paused";
  if (!why_time_is_fixed().empty() || controls().slow == 1) return "";
  return fmt::format("1/{} speed", controls().slow);
}

std::string LiveStage::why_no_magnet() const {
  const auto& objects = stage_->document().scene.objects;
  return std::ranges::any_of(objects, [](const Object& o) { return o.body && o.body->magnet; })
             ? ""
             : "Nothing in this scene can be picked up.";
}

void LiveStage::toggle_magnet() {
  controls().magnet = !controls().magnet && why_no_magnet().empty();
  notices_.say(controls().magnet ? "The magnet is on. An object that the tip touches sticks to the "
                                   "tip. Press H to let the object go."
                                 : "The magnet is off.");
}

void LiveStage::start_over() {
  if (recording()) {
    notices_.say("Stop the recording before you start over.", true);
    return;
  }
  controls().grab = controls().magnet = false;
  controls().pull = {};
  ++controls().resets;
  const bool off = loop().device_in_place() || !force_armed();
  notices_.say(off ? "The simulation has started over, at rest and without force. Key F switches "
                     "the force on."
                   : "The simulation has started over, at rest.");
}

void LiveStage::let_go(std::unique_ptr<Device> device) {
  device_tasks_.run(
      [done = std::shared_ptr<Device>(std::move(device))]() mutable { done.reset(); });
}

std::string LiveStage::why_lanes_are_fixed() const {
  if (recording()) return "Stop the recording before you add or end a run.";
  if (loop().device_in_place()) {
    return "Only the virtual arm can have several runs at the same time: one hand cannot hold two "
           "real devices.";
  }
  return {};
}

void LiveStage::update(std::span<const Parameters> lanes) {
  std::ranges::copy(lanes, controls().lanes.begin());
  session_.run_lanes(lanes.size());
  for (std::size_t lane = 0; lane < lanes.size(); ++lane) stage_->follow(lanes[lane], lane);
  tell(session_.turn([this](LaneRows rows, std::uint64_t tick) {
    stage_->append(rows);
    grip_.take(rows[kMainLane]);
    if (on_row) on_row(rows, tick);
  }));
  grip_.update();
  follow_saving();
  set_marks();
  stage_->follow_energy(stage_->history.end());
  watch_loop();
}

void LiveStage::mark(const std::string& label, const std::string& key) {
  changes_.push_back({0, key, label});
}

LiveStage::Moment LiveStage::now() const {
  Moment at{.time = stage_->history.end_time()};
  if (!loop().recording()) return at;
  at.row = loop().recorded_row(session_.tick());
  at.recording = loop().recorder();
  return at;
}

void LiveStage::note(const Moment& at, const std::string& text) {
  if (at.row && loop().recording() && loop().recorder() == at.recording) {
    loop().mark({*at.row, text});
  } else if (at.row) {
    notices_.say("The recording has ended. The mark is only in the plots, not in the recording.");
  }
  if (stage_->history.marks().size() == History::kMostMarks) {
    notices_.say_once(
        fmt::format("The plots show only the newest {} marks. A recording keeps all marks.",
                    History::kMostMarks),
        false);
  }
  stage_->history.mark_at(at.time, text, kNoteMark);
}

// Sets marks after the rows of before the change: however long a frame takes, a mark stands at its
// change.
void LiveStage::set_marks() {
  History& history = stage_->history;
  for (PlotMark& change : changes_) {
    history.mark(history.end_time() - history.offset(), std::move(change.label),
                 std::move(change.key));
  }
  changes_.clear();
}

void LiveStage::watch_loop() {
  const LoopStatus now = loop().status();
  if (was_running_ && !now.running) {
    notices_.say(
        fmt::format("The loop has stopped, and the force is off. Reason: {}. Start Limpid again.",
                    now.failure),
        true);
  }
  was_running_ = now.running;
}

bool LiveStage::became_unstable() {
  const bool diverged = loop().snapshot().diverged;
  return !std::exchange(was_diverged_, diverged) && diverged;
}

bool LiveStage::may_record() {
  if (session_.opening_recording()) return false;
  if (session_.closing()) notices_.say("The last recording is still being closed.");
  return !session_.closing();
}

void LiveStage::record(const RunPlan& plan, const fs::path& file, bool replaces) {
  SessionInfo about = session_info(plan);
  if (loop().device_in_place()) about.safety = limits_text(controls().limits);
  session_.record(std::move(about), plan.settings(), file, replaces);
}

// Tells what has become of the recording.
void LiveStage::tell(const RecordingNews& news) {
  const Recorded& last = session_.last_recording();
  if (!news.note.empty()) notices_.say(news.note);
  if (news.began) mark("recording", kRecordingMark);
  if (news.ended) recorded_ = last.file;
  if (news.complete) {
    const std::string missing =
        last.dropped > 0 ? fmt::format(", {} ticks missing", last.dropped) : "";
    notices_.say(
        fmt::format("Recorded {}{}. Play it with P.", last.file.filename().string(), missing),
        last.dropped > 0);
  }
  if (!news.failure.empty()) notices_.say(news.failure, true);
}

void LiveStage::save_beside(std::function<PlotNotice()> work) {
  saving_.push_back(file_tasks_.run(std::move(work)));
}

void LiveStage::follow_saving() {
  for (std::future<PlotNotice>& saving : saving_) {
    const auto notice = take_ready(saving);
    if (!notice) continue;
    if (!notice->file.empty()) written_ = notice->file;
    if (!notice->text.empty()) notices_.say(notice->text, notice->bad);
  }
  std::erase_if(saving_, [](const std::future<PlotNotice>& saving) { return !saving.valid(); });
}

}  // namespace limpid
