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
    : settings(std::move(s)), parameters(settings.parameters), live(ask), devices(ask) {
  known_.parameters = analysed_ = parameters;
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
                     std::unique_ptr<Device> device) {
  auto fresh =
      std::make_unique<Stage>(std::move(arm), std::move(scene), models,
                              StageOptions{.tick = parameters.tick, .shown = settings.plot_length});
  controls.grab = false;
  controls.goal = home(fresh->arm());
  if (device) {
    live.open(fresh->arm(), fresh->scene(), parameters, std::move(device));
  } else {
    live.open(fresh->arm(), fresh->scene(), parameters, controls.goal);
  }
  stage = std::move(fresh);
  editor.open(stage->scene(), std::move(models));
  known_.scene = shown_ = editor.version();
  touched_ = shown_.world;
  // Steps of other scenes cannot be undone in this one.
  history.rewrite(
      [&](EditState& state) { state.scene = shown_; },
      [](const EditState& a, const EditState& b) { return a.parameters == b.parameters; });
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
  note_changes();
  follow_parameters();
  show_scene();
  hand_scene_over(false);
  controls.parameters = parameters;
  live.set(controls);
  live.update();
  take_rows();
  take_results();
  take_loaded();
  devices.update(*this);
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
    plan.scene = editor.scene();
    plan.scene.toml = scene_toml();
    hand_scene_over(true);
    plan.hand.source = "mouse";
    plan.parameters = parameters;
    live.record(sessions_dir() / name, session_info(plan), parameters, false);
    stage->history.mark(stage->channels().layout().in(row(), Column::time)[0], "recording", "rec");
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

}  // namespace limpid
