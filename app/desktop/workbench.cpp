#include "app/desktop/workbench.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "app/assets.h"
#include "app/desktop/window.h"
#include "app/run/replay.h"
#include "core/dynamics/arm.h"
#include "devices/files/scene_file.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

using SteadyClock = std::chrono::steady_clock;
constexpr std::size_t kDrainRows = 512;
constexpr std::size_t kMostUndo = 200;

// Where a new loop rests: the tip as at the middle of the arm's limits.
Vec3 home(const ArmDescription& arm) {
  const Eigen::VectorXd x = rest_pose(arm);
  return RowView(arm).tip({x.data(), static_cast<std::size_t>(x.size())});
}

}  // namespace

Workbench::Workbench(Settings s, AskForPriority ask)
    : settings(std::move(s)), parameters(settings.parameters), live(std::move(ask)) {
  known_ = parameters;
  controls.parameters = parameters;
}

Workbench::~Workbench() {
  live.close();
  if (live.recording()) {
    try {
      live.stop_recording();
    } catch (const std::exception& e) {
      fmt::print(stderr, "limpid: {}\n", e.what());
    }
  }
}

void Workbench::open_world(const std::string& device, const std::string& scene) {
  device_file = device.empty() ? default_device().string() : device;
  scene_file = scene.empty() ? default_scene().string() : scene;
  ArmDescription arm = read_urdf(device_file);
  Scene read = read_scene(scene_file, arm);
  open(std::move(arm), std::move(read));
}

void Workbench::open_scene(const std::filesystem::path& file) {
  if (live.recording()) {
    say("Stop the recording before changing the scene.", true);
    return;
  }
  try {
    Scene scene = read_scene(file, stage->arm());
    scene_file = file.string();
    settings.scene = scene_file;
    open(stage->arm(), std::move(scene));
    say(fmt::format("Scene: {}", stage->scene().title));
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

void Workbench::open(ArmDescription arm, Scene scene) {
  auto fresh =
      std::make_unique<Stage>(std::move(arm), std::move(scene),
                              StageOptions{.tick = parameters.tick, .shown = settings.plot_length});
  controls.grab = false;
  controls.goal = home(fresh->arm());
  live.open(fresh->arm(), fresh->scene(), parameters, controls.goal);
  stage = std::move(fresh);
  rows_.assign(kDrainRows * static_cast<std::size_t>(live.layout().stride()), 0.0);
  camera.reset(stage->picture.bounds());
  camera.finish();
  analysis = analyze(stage->arm(), rest_pose(stage->arm()), parameters, std::nullopt);
}

void Workbench::drop_pictures() {
  live.close();
  playback.reset();
  stage.reset();
}

void Workbench::update(double dt) {
  follow_parameters();
  controls.parameters = parameters;
  live.set(controls);
  live.update();
  take_rows();
  take_results();
  if (playback) playback->player.advance(dt);
  camera.advance(dt);
  if (live.snapshot().diverged && !was_diverged_) {
    cut_force();
    say("The loop became unstable; force is off. Choose a larger eta or a smaller alpha, then "
        "start over (Backspace).",
        true);
  }
  was_diverged_ = live.snapshot().diverged;
  if (live.recording() && live.recorder()->failed()) toggle_recording();
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

// Notices what a panel, a key or undo changed: marks it in the plots, remembers it for undo. A
// slider that is being dragged makes one step of undo.
void Workbench::follow_parameters() {
  const auto now = SteadyClock::now();
  if (before_change_ && now - last_change_ > std::chrono::milliseconds(500)) {
    undo_.push_back(*before_change_);
    if (undo_.size() > kMostUndo) undo_.erase(undo_.begin());
    redo_.clear();
    before_change_.reset();
  }
  if (parameters == known_) return;
  if (!before_change_) before_change_ = known_;
  last_change_ = now;
  for (const ParameterInfo& info : parameter_table()) {
    const std::string text = parameter_text(parameters, info);
    if (text == parameter_text(known_, info)) continue;
    const double time = stage->channels().layout().in(row(), Column::time)[0];
    if (!playback) {
      std::string value = text.empty() ? "the arm's" : text;
      std::erase(value, '"');
      stage->history.mark(time, fmt::format("{} {}", info.label, value), info.key);
    }
  }
  known_ = parameters;
  const ArmDescription& arm = shown().arm();
  analysis = analyze(arm, rest_pose(arm), parameters, std::nullopt);
}

void Workbench::toggle_coupling() {
  parameters.kind =
      parameters.kind == CouplingKind::standard ? CouplingKind::proposed : CouplingKind::standard;
}

void Workbench::start_over() {
  if (live.recording()) {
    say("Stop the recording before starting over.", true);
    return;
  }
  controls.grab = false;
  ++controls.resets;
  controls.force = true;
  say("Started over: at rest, force on.");
}

void Workbench::undo() {
  if (before_change_) {
    redo_.push_back(parameters);
    parameters = known_ = *before_change_;
    before_change_.reset();
  } else if (!undo_.empty()) {
    redo_.push_back(parameters);
    parameters = known_ = undo_.back();
    undo_.pop_back();
  }
}

void Workbench::redo() {
  if (redo_.empty()) return;
  undo_.push_back(parameters);
  parameters = known_ = redo_.back();
  redo_.pop_back();
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
  say("Saved " + (sessions_dir() / name).string());
}

void Workbench::toggle_recording() {
  try {
    if (live.recording()) {
      last_recording = live.recorder()->out();
      const std::uint64_t dropped = live.recorder()->dropped();
      live.stop_recording();
      say(fmt::format("Recorded {}{}. Play it with P.", last_recording.filename().string(),
                      dropped > 0 ? fmt::format(", {} ticks missing", dropped) : ""),
          dropped > 0);
      return;
    }
    close_playback();
    const std::string name =
        fmt::format("session-{:%Y%m%d-%H%M%S}.h5", fmt::localtime(std::time(nullptr)));
    RunPlan plan;
    plan.arm = stage->arm();
    plan.scene = stage->scene();
    plan.hand.source = "mouse";
    plan.parameters = parameters;
    live.record(sessions_dir() / name, session_info(plan), parameters, false);
    stage->history.mark(stage->channels().layout().in(row(), Column::time)[0], "recording", "rec");
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

}  // namespace limpid
