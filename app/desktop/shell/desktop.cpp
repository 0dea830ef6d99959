#include "app/desktop/shell/desktop.h"

#include <fmt/format.h>

#include <tuple>

#include "app/base/assets.h"
#include "app/base/user_dirs.h"
#include "app/desktop/base/passivity_break.h"
#include "app/desktop/base/thumbnails.h"
#include "app/desktop/sweep/sweep_desk.h"
#include "app/run/fitted_gains.h"
#include "app/run/own_world.h"
#include "app/run/twin_settings.h"
#include "app/style/words.h"
#include "core/dynamics/arm.h"
#include "devices/files/arm/urdf_file.h"
#include "devices/files/config/config_file.h"
#include "devices/files/scene/scene_file.h"

namespace limpid {

namespace fs = std::filesystem;

Desktop::Desktop(Settings settings, const AskForPriority& ask)
    : settings_(std::move(settings)),
      document_(settings_, notices_, [this] { return why_fixed(); }),
      desk_(notices_, ask),
      devices_(desk_, notices_, ask,
               {.open = [this](std::unique_ptr<Device> device) { open_device(std::move(device)); },
                .close = [this] { close_device(); },
                .toggle_coupling = [this] { toggle_coupling(); }}),
      identify_(desk_, devices_, notices_),
      playback_(notices_),
      sweep_(std::make_unique<SweepDesk>(notices_)),
      layouts_(data_dir() / "assets/layouts.toml", user_config_dir() / "layouts.toml"),
      presets_(data_dir() / "assets/presets.toml", user_config_dir() / "presets.toml"),
      analysed_(settings_.parameters),
      analysed_twin_(settings_.twin.parameters) {
  desk_.controls().parameters = settings_.parameters;
}

Desktop::~Desktop() = default;

void Desktop::open_world(const std::string& device, const std::string& tip,
                         const std::string& scene) {
  device_file_ = device.empty() ? default_device().string() : device;
  device_tip_ = tip;
  ArmDescription arm = load_arm(device_file_, tip, consent(device_file_)).arm;
  const fs::path file = scene.empty() ? default_scene(arm) : fs::absolute(scene);
  SceneDocument whole = read_scene(file, arm);
  if (std::ranges::none_of(whole.scene.objects, has_shape<Mesh>)) {
    document_.set_file(file.string());
    return open(std::move(arm), std::move(whole), {});
  }
  // Models may be large: they come in while the window is there already. Saving what is there
  // without them must not write over the scene's own file.
  std::erase_if(whole.scene.objects, has_shape<Mesh>);
  whole.models.clear();
  whole.toml.clear();
  document_.set_file(default_scene(arm).string());
  open(std::move(arm), std::move(whole), {});
  first_scene_ = file.string();
  document_.loader().open_scene(file, desk_.stage().arm());
}

void Desktop::open_last_world(const std::string& device, const std::string& tip,
                              const std::string& scene, bool fixed) {
  std::string arm = device, end = tip, world = scene;
  expanded_ = device;  // who names a file on the command line means it
  if (device.empty()) std::tie(arm, end) = last_arm();
  const ArmDescription first =
      read_urdf(arm.empty() ? default_device().string() : arm, end, consent(arm));
  if (fixed) fitted_for_ = first;
  if (scene.empty() && (device.empty() || suits_default_world(first))) world = settings_.scene;
  try {
    open_world(arm, end, world);
  } catch (const std::exception& e) {
    if (!scene.empty() || world.empty()) throw;
    open_world(arm, end, "");
    notices_.say(e.what(), true);
  }
  if (!arm.empty()) say_about_arm();
}

void Desktop::open(ArmDescription arm, SceneDocument document, MeshModels models,
                   std::unique_ptr<Device> device, bool saved) {
  end_break();
  fit_to(arm);
  take_compensation(device != nullptr);
  desk_.open(std::move(arm), std::move(document), models, settings_.parameters,
             settings_.plot_length, std::move(device));
  take_stage(std::move(models), saved);
}

// The stage's scene is the one that is edited from now on.
void Desktop::take_stage(MeshModels models, bool saved) {
  const Stage& stage = desk_.stage();
  if (!playback_.on()) {
    reset_view();
    camera_.finish();
  }
  analysis_ = analyze(stage.arm(), rest_pose(stage.arm()), settings_.parameters, std::nullopt);
  document_.open(stage.arm(), stage.document(), std::move(models), saved);
  shown_ = document_.editor().version();
  touched_ = shown_.world;
}

void Desktop::look(Camera::View view) {
  automatic_view_ = false;
  camera_.look(view);
}

void Desktop::reset_view() {
  automatic_view_ = true;
  camera_.reset(shown().picture.bounds());
}

void Desktop::drop_pictures() {
  playback_.drop_pictures();
  desk_.drop_pictures();
}

void Desktop::update(double dt) {
  if (end_break_by_law(settings_)) notices_.say(kBreakEnded);
  document_.note_changes();
  follow_twin();
  follow_parameters();
  shown().choose_plots(settings_.plot_choices);
  show_scene();
  hand_scene_over(false);
  desk_.update(settings_.parameters, settings_.twin.on ? &settings_.twin.parameters : nullptr);
  if (const auto recorded = desk_.take_recorded()) {
    playback_.set_last(*recorded);
    make_thumbnail(*recorded, desk_.stage(), desk_.row(), desk_.twin_row(), settings_.theme);
    remember_recent(settings_, recorded->string());
  }
  follow_playback(dt);
  follow_story();
  take_loaded();
  devices_.update();
  identify_.update();
  note_compensation();
  camera_.advance(dt);
  if (desk_.became_unstable()) {
    cut_force();
    notices_.say(
        "The loop became unstable; force is off. Choose a larger eta or a smaller alpha, start "
        "over (Backspace), then F.",
        true);
  }
  notices_.forget_old();
}

std::span<const double> Desktop::row() const {
  return playback_.on() ? playback_.shown()->player().row() : desk_.row();
}

std::span<const double> Desktop::twin_row() const {
  return playback_.on() ? playback_.shown()->twin_row() : desk_.twin_row();
}

Parameters& Desktop::edited() {
  return edits_twin() ? settings_.twin.parameters : settings_.parameters;
}

// One hand, one device, one world for both; what the plots call them.
void Desktop::follow_twin() {
  TwinSettings& twin = settings_.twin;
  if (desk_.loop().device_in_place()) twin.on = false;
  share_world(settings_.parameters, twin.parameters);
  if (!twin.on) return desk_.stage().name_runs({});
  const auto names = twin_names(settings_.parameters, twin.parameters);
  desk_.stage().name_runs({names[0], names[1], true});
}

// What a story's step wants to be looked at from, and what it calls the runs.
void Desktop::follow_story() {
  const StoryStep* step = playback_.on() ? playback_.shown()->step() : nullptr;
  if (step == step_) return;
  step_ = step;
  if (step == nullptr) return reset_view();
  playback_.shown()->stage().name_runs({step->names[0], step->names[1], true});
  const StoryCamera aim = camera_in(playback_.shown()->steps(), *step);
  reset_view();
  if (!aim.of && aim.view == Camera::View::iso) return;
  look(aim.view);
  camera_.frame(aim.of.value_or(shown().picture.bounds()));
}

// In the plots. What both runs have in common is marked once.
void Desktop::mark_changes(const Parameters& now, const Parameters& before,
                           const std::string& whose) {
  for (const ParameterInfo& info : parameter_table()) {
    if (parameter_text(now, info) == parameter_text(before, info)) continue;
    if (!whose.empty() && !own_of_twin(info)) continue;
    desk_.mark(whose + mark_text(info, now), whose + info.key);
  }
}

void Desktop::follow_parameters() {
  const Parameters &first = settings_.parameters, &twin = settings_.twin.parameters;
  const bool changed = !(first == analysed_) || !(twin == analysed_twin_);
  if (!changed && analysed_of_twin_ == edits_twin()) return;
  if (!playback_.on()) {
    mark_changes(first, analysed_, "");
    if (settings_.twin.on) mark_changes(twin, analysed_twin_, "twin: ");
  }
  analysed_ = first;
  analysed_twin_ = twin;
  analysed_of_twin_ = edits_twin();
  const ArmDescription& arm = shown().arm();
  analysis_ = analyze(arm, rest_pose(arm), edited(), std::nullopt);
}

int Desktop::quality_level() const {
  if (settings_.picture_quality == "high") return 0;
  if (settings_.picture_quality == "medium") return 2;
  if (settings_.picture_quality == "low") return Quality::kLowest;
  return automatic_quality_.level();
}

Focus Desktop::focus() const {
  return {.text = typing(),
          .popup = popup_open(),
          .question = document_.asking(),
          .dialog = dialog_,
          .playback = playback_.on()};
}

void Desktop::toggle_coupling() {
  if (passivity_broken(settings_)) return end_break();
  edited().kind = next(edited().kind);
}

void Desktop::break_passivity() {
  if (desk_.loop().device_in_place() || playback_.on()) return;
  limpid::break_passivity(settings_, desk_.stage().arm());
}

void Desktop::end_break() {
  if (!passivity_broken(settings_)) return;
  end_passivity_break(settings_);
  notices_.say(kBreakEnded);
}

void Desktop::toggle_twin() {
  if (const std::string why = desk_.why_twin_is_fixed(); !why.empty()) {
    return notices_.say(why, true);
  }
  end_break();
  playback_.close();
  TwinSettings& twin = settings_.twin;
  twin.on = !twin.on;
  twin.edited = false;
  if (!twin.on) return notices_.say("The twin is gone. B brings it back.");
  if (twin.parameters.kind == settings_.parameters.kind &&
      twin.parameters.eta == settings_.parameters.eta) {
    using enum CouplingKind;
    twin.parameters.kind = settings_.parameters.kind == standard ? predictive : standard;
  }
  notices_.say("Two couplings on one hand. The tabs choose which one the sliders set.");
}

void Desktop::cut_force() {
  desk_.loop().cut();
  devices_.cancel_check();
  if (identify_.moving()) identify_.stop();  // what was found stays
}

void Desktop::reset_parameters() {
  end_break();
  settings_.parameters = fitted(desk_.stage().arm());
  const bool usual = settings_.parameters == Parameters{};
  notices_.say(usual
                   ? "All settings have their usual values again, the paper's where it gives them."
                   : "All settings have their usual values again, with gains fitted to this arm.");
}

void Desktop::toggle_recording() {
  if (desk_.loop().recording()) return desk_.stop_recording();
  if (!desk_.may_record()) return;
  try {
    start_recording();
  } catch (const std::exception& e) {
    notices_.say(e.what(), true);
  }
}

void Desktop::start_recording() {
  playback_.close();
  RunPlan plan;
  plan.arm = desk_.stage().arm();
  plan.document = document_.editor().document();
  plan.document.toml = document_.toml();
  plan.hand.source = desk_.loop().device_in_place() ? "device" : "mouse";
  plan.parameters = settings_.parameters;
  if (settings_.twin.on) plan.twin = TwinPlan{settings_.twin.parameters, {}, {}};
  hand_scene_over(true);
  desk_.record(plan, sessions_dir());
}

void Desktop::toggle_playing() {
  if (playback_.on()) {
    playback_.toggle_playing();
  } else if (!playback_.last().empty()) {
    playback_.open(playback_.last());
  } else {
    open_dialog(Dialog::open_session);
  }
}

void Desktop::play_story() {
  settings_.hint_seen = true;
  playback_.open_story();
}

}  // namespace limpid
