#include "app/desktop/workbench.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "app/base/assets.h"
#include "app/desktop/window.h"
#include "app/run/replay.h"
#include "core/dynamics/arm.h"
#include "devices/files/arm/urdf_file.h"
#include "devices/files/scene/scene_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using SteadyClock = std::chrono::steady_clock;
constexpr std::size_t kDrainRows = 512;

// Where a new loop rests: the tip as at the middle of the arm's limits.
Vec3 home(const ArmDescription& arm) {
  const Eigen::VectorXd x = rest_pose(arm);
  return RowView(arm).tip({x.data(), static_cast<std::size_t>(x.size())});
}

}  // namespace

Workbench::Workbench(Settings s, AskForPriority ask)
    : settings(std::move(s)),
      parameters(settings.parameters),
      live(ask, [this](std::unique_ptr<Device> device) { let_go(std::move(device)); }),
      devices(ask) {
  known_.parameters = analysed_ = parameters;
  controls.parameters = parameters;
}

// What is recorded is complete before the program ends.
Workbench::~Workbench() {
  live.close();
  try {
    if (opening_recording_.valid()) {  // it never began
      const std::unique_ptr<Recorder> empty = opening_recording_.get();
      empty->finish();
      fs::remove(empty->out());
    }
    live.finish_recording();
    if (closing_recording_.valid()) closing_recording_.get();
  } catch (const std::exception& e) {
    fmt::print(stderr, "limpid: {}\n", e.what());
  }
}

void Workbench::open_world(const std::string& device, const std::string& scene) {
  device_file = device.empty() ? default_device().string() : device;
  scene_file = scene.empty() ? default_scene().string() : fs::absolute(scene).string();
  ArmDescription arm = read_urdf(device_file);
  Scene whole = read_scene(scene_file, arm);
  if (whole.meshes.empty()) return open(std::move(arm), std::move(whole), {});
  // Models may be large: they come in while the window is there already.
  Scene first = whole;
  first.meshes.clear();
  open(std::move(arm), std::move(first), {});
  loader.open_scene(scene_file, stage->arm());
}

void Workbench::open(ArmDescription arm, Scene scene, MeshModels models,
                     std::unique_ptr<Device> device, bool saved) {
  auto fresh = make_stage(std::move(arm), std::move(scene), models);
  const Vec3 rest = home(fresh->arm());
  if (device) {
    live.open(fresh->arm(), fresh->scene(), parameters, std::move(device));
  } else {
    live.open(fresh->arm(), fresh->scene(), parameters, rest);
  }
  controls.grab = false;
  controls.goal = rest;
  take_stage(std::move(fresh));
  take_scene(std::move(models), saved);
}

void Workbench::open_beside(Scene scene, MeshModels models) {
  cut_force();
  auto fresh = make_stage(stage->arm(), std::move(scene), models);
  live.exchange(std::make_unique<TouchWorld>(fresh->arm(), fresh->scene()));
  take_stage(std::move(fresh));
  take_scene(std::move(models));
}

std::unique_ptr<Stage> Workbench::make_stage(ArmDescription arm, Scene scene,
                                             const MeshModels& models) const {
  const int channels = TraceChannels(RowLayout(arm.dof())).count();
  return std::make_unique<Stage>(std::move(arm), std::move(scene), models,
                                 History({.channels = channels, .tick = parameters.tick}),
                                 settings.plot_length);
}

void Workbench::take_stage(std::unique_ptr<Stage> fresh) {
  stage = std::move(fresh);
  rows_.assign(kDrainRows * static_cast<std::size_t>(live.layout().stride()), 0.0);
  camera.reset(stage->picture.bounds());
  camera.finish();
  analysis = analyze(stage->arm(), rest_pose(stage->arm()), parameters, std::nullopt);
}

// The stage's scene is the one that is edited from now on, as its file has it.
void Workbench::take_scene(MeshModels models, bool saved) {
  editor.open(stage->scene(), std::move(models), saved);
  known_.scene = shown_ = editor.version();
  touched_ = shown_.world;
  // Steps of other scenes cannot be undone in this one.
  history.rewrite(
      [&](EditState& state) { state.scene = shown_; },
      [](const EditState& a, const EditState& b) { return a.parameters == b.parameters; });
}

void Workbench::drop_pictures() {
  live.close();
  playback.reset();
  stage.reset();
}

void Workbench::update(double dt) {
  note_changes();
  follow_parameters();
  show_scene();
  hand_scene_over(false);
  controls.parameters = parameters;
  live.set(controls);
  live.update();
  follow_recording();
  take_rows();
  take_results();
  take_loaded();
  devices.update(*this);
  if (playback) playback->player.advance(dt);
  camera.advance(dt);
  if (live.snapshot().diverged && !was_diverged_) {
    cut_force();
    say("The loop became unstable; force is off. Choose a larger eta or a smaller alpha, start "
        "over (Backspace), then F.",
        true);
  }
  was_diverged_ = live.snapshot().diverged;
  const LoopStatus loop = live.status();
  if (was_running_ && !loop.running) {
    say(fmt::format("The loop has stopped, without force: {}. Start Limpid again.", loop.failure),
        true);
  }
  was_running_ = loop.running;
  while (!notices.empty() && notices.front().until < SteadyClock::now()) notices.pop_front();
}

std::span<const double> Workbench::row() const {
  if (playback) return playback->player.row();
  return std::span(live.snapshot().row).first(static_cast<std::size_t>(live.layout().stride()));
}

void Workbench::take_rows() {
  const auto stride = static_cast<std::size_t>(live.layout().stride());
  while (const std::size_t count = live.drain(rows_)) {
    for (std::size_t i = 0; i < count; ++i) {
      stage->append(std::span<const double>(rows_).subspan(i * stride, stride));
    }
  }
}

// Notices what a panel, a key or a mouse changed, for undo.
void Workbench::note_changes() {
  const EditState now{parameters, editor.version()};
  const bool scene = now.scene.world != known_.scene.world;
  std::string what = scene ? editor.last_change() : "";
  if (!(parameters == known_.parameters)) {
    for (const ParameterInfo& info : parameter_table()) {
      const bool same = parameter_text(parameters, info) == parameter_text(known_.parameters, info);
      if (!same) what = scene ? "" : info.key;
    }
    history.changed(known_, what, SteadyClock::now());
  } else if (scene) {
    history.changed(known_, what, SteadyClock::now());
  }
  known_ = now;
}

// Marks in the plots what has changed.
void Workbench::follow_parameters() {
  if (parameters == analysed_) return;
  for (const ParameterInfo& info : parameter_table()) {
    const std::string text = parameter_text(parameters, info);
    if (text == parameter_text(analysed_, info)) continue;
    const double time = stage->channels().layout().in(row(), Column::time)[0];
    if (!playback) {
      std::string value = text.empty() ? "the arm's" : text;
      std::erase(value, '"');
      stage->history.mark(time, fmt::format("{} {}", info.label, value), info.key);
    }
  }
  analysed_ = parameters;
  const ArmDescription& arm = shown().arm();
  analysis = analyze(arm, rest_pose(arm), parameters, std::nullopt);
}

void Workbench::toggle_coupling() { parameters.kind = next(parameters.kind); }

bool Workbench::force_armed() const {
  const Arming now = live.snapshot().arming;
  return now != Arming::off && now != Arming::tripped;
}

void Workbench::start_over() {
  if (recording()) {
    say("Stop the recording before starting over.", true);
    return;
  }
  controls.grab = false;
  ++controls.resets;
  const bool off = live.device_in_place() || !force_armed();
  say(off ? "Started over, at rest and without force; F arms it." : "Started over, at rest.");
}

void Workbench::go_to(const std::optional<EditState>& state) {
  if (!state) return;
  parameters = state->parameters;
  editor.restore(state->scene);
  known_ = *state;
}

void Workbench::undo() {
  note_changes();
  const EditState* next = history.next_undo();
  if (next == nullptr) return say("Nothing to undo.");
  if (next->scene.world != known_.scene.world && !may_edit()) return;
  go_to(history.undo(known_));
}

void Workbench::redo() {
  note_changes();
  const EditState* next = history.next_redo();
  if (next == nullptr) return say("Nothing to redo.");
  if (next->scene.world != known_.scene.world && !may_edit()) return;
  go_to(history.redo(known_));
}

void Workbench::reset_parameters() {
  parameters = Parameters{};
  say("All settings are the paper's again.");
}

void Workbench::say(std::string text, bool bad) {
  const auto seconds = std::chrono::seconds(bad ? 10 : 5);
  notices.push_back({std::move(text), bad, SteadyClock::now() + seconds});
}

void Workbench::save_picture(Window& window) {
  const std::string name =
      fmt::format("limpid-{:%Y%m%d-%H%M%S}.png", fmt::localtime(std::time(nullptr)));
  window.save_picture(sessions_dir() / name);
}

int Workbench::quality_level() const {
  if (settings.picture_quality == "high") return 0;
  if (settings.picture_quality == "medium") return 2;
  if (settings.picture_quality == "low") return Quality::kLowest;
  return automatic_quality.level();
}

void Workbench::toggle_recording() {
  if (live.recording()) return live.stop_recording();
  if (opening_recording_.valid()) return;
  if (closing_recording_.valid()) return say("The last recording is still being closed.");
  try {
    start_recording();
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

void Workbench::start_recording() {
  close_playback();
  const std::string name =
      fmt::format("session-{:%Y%m%d-%H%M%S}.h5", fmt::localtime(std::time(nullptr)));
  RunPlan plan;
  plan.arm = stage->arm();
  plan.scene = editor.scene();
  plan.scene.toml = scene_toml();
  hand_scene_over(true);
  plan.hand.source = live.device_in_place() ? "device" : "mouse";
  plan.parameters = parameters;
  SessionInfo about = session_info(plan);
  if (live.device_in_place()) about.safety = limits_text(controls.limits);
  opening_recording_ = file_errands.run(
      [file = sessions_dir() / name, info = std::move(about), initial = parameters] {
        return std::make_unique<Recorder>(file, info, initial, false);
      });
}

void Workbench::follow_recording() {
  try {
    if (auto recorder = take_ready(opening_recording_)) {
      live.record(std::move(*recorder));
      stage->history.mark(stage->channels().layout().in(row(), Column::time)[0], "recording",
                          "rec");
    }
    if (live.recording() && live.recorder()->failed()) live.stop_recording();
    if (std::shared_ptr<Recorder> done = live.take_recorded()) {
      last_recording = done->out();
      closing_recording_ = file_errands.run([done] {
        done->finish();
        const std::uint64_t dropped = done->dropped();
        const std::string missing = dropped > 0 ? fmt::format(", {} ticks missing", dropped) : "";
        return Notice{
            fmt::format("Recorded {}{}. Play it with P.", done->out().filename().string(), missing),
            dropped > 0,
            {}};
      });
    }
    if (auto notice = take_ready(closing_recording_)) say(notice->text, notice->bad);
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

}  // namespace limpid
