#include "app/desktop/coupling/tuning.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <span>

#include "app/base/folders.h"
#include "app/desktop/base/passivity_break.h"
#include "app/desktop/base/window_layout.h"
#include "app/run/fitted_gains.h"
#include "app/run/lane_settings.h"
#include "app/style/words.h"
#include "core/dynamics/arm.h"
#include "devices/files/config_file.h"

namespace limpid {

Tuning::Tuning(Settings& settings, Notices& notices, LiveStage& live, DeviceController& devices,
               Playback& playback)
    : presets(data_dir() / "assets/presets.toml", user_config_dir() / "presets.toml"),
      settings_(settings),
      notices_(notices),
      live_(live),
      devices_(devices),
      playback_(playback),
      marked_(settings.lanes.parameters) {}

void Tuning::next_law() {
  if (passivity_broken(settings_)) return end_break();
  Parameters& p = edited();
  do {
    p.kind = next(p.kind);
  } while (info(p.kind).for_comparison || (info(p.kind).for_links && !p.linked()));
}

void Tuning::toggle_twin() {
  const std::size_t before = settings_.lanes.count;
  run_lanes(before > 1 ? 1 : 2);
  notices_.say(before == 1
                   ? "Two couplings on one hand. The tabs choose the coupling that the sliders set."
               : before == 2 ? "The twin (second run) has ended. Key B starts the twin again."
                             : "Only the first run is left. Key B starts a second run again.");
}

void Tuning::add_lane() {
  run_lanes(settings_.lanes.count + 1);
  notices_.say(
      fmt::format("{} couplings on one hand. The tabs choose the coupling that the sliders set.",
                  settings_.lanes.count == 2 ? "Two" : "Three"));
}

void Tuning::drop_lane() {
  run_lanes(settings_.lanes.count - 1);
  notices_.say(fmt::format("The {} run has ended.", lane_ordinal(settings_.lanes.count)));
}

// Lets this many lanes run. A lane that would be like another one gets a law that none has.
void Tuning::run_lanes(std::size_t count) {
  end_break();
  playback_.close();
  LaneSettings& lanes = settings_.lanes;
  for (std::size_t i = lanes.count; i < count; ++i) {
    const auto there = std::span(lanes.parameters).first(i);
    Parameters& added = lanes.parameters[i];
    const bool alike = std::ranges::any_of(
        there, [&](const Parameters& p) { return p.kind == added.kind && p.eta == added.eta; });
    if (alike) added.kind = law_beside(there);
  }
  lanes.count = count;
  lanes.edited = kMainLane;
}

void Tuning::break_passivity() { limpid::break_passivity(settings_, live_.stage().arm()); }

void Tuning::end_break() {
  if (!passivity_broken(settings_)) return;
  end_passivity_break(settings_);
  notices_.say(kBreakEnded);
}

void Tuning::reset() {
  end_break();
  settings_.parameters() = fitted(live_.stage().arm());
  const bool usual = settings_.parameters() == Parameters{};
  notices_.say(usual
                   ? "All settings are back at their default values. Where the paper gives a "
                     "value, the default is the paper's value."
                   : "All settings have their usual values again, with gains fitted to this arm.");
}

void Tuning::use_preset(const std::string& name) {
  const NamedTexts::Entry* preset = presets.find(name);
  if (preset == nullptr) return;
  end_break();
  apply_preset(edited(), preset->text, name);
  notices_.say(fmt::format("Settings: {}. Ctrl+Z brings back the earlier settings.", name));
}

// Fits the gains, as those for the arm before may be far too stiff. A device's compensation of its
// own weight is remembered with the device, and no later arm gets it.
Tuning::Suited Tuning::suited(const ArmDescription& arm, const DeviceTraits* device) const {
  Suited s{settings_.lanes.parameters, fitted_for_, of_virtual_, device_, encoder_of_device_};
  Parameters& first = s.lanes[kMainLane];
  if (!s.fitted_for || s.fitted_for->urdf != arm.urdf) {
    const ArmDescription* before = fitted_for_ ? &*fitted_for_ : nullptr;
    for (Parameters& p : s.lanes) refit(p, before, &arm);
    s.fitted_for = arm;
  }
  const OfVirtualArm of_virtual = s.of_virtual ? *s.of_virtual : OfVirtualArm::of(first);
  s.of_virtual.reset();
  of_virtual.give(first);
  if (device == nullptr) return s;
  s.of_virtual = of_virtual;
  s.device = devices_.hub().in_use();
  devices_.hub().notes(s.device).compensation.give(first);
  first.encoder_step = s.encoder_of_device = encoder_step_of(*device);
  return s;
}

void Tuning::take(Suited suited) {
  settings_.lanes.parameters = suited.lanes;
  fitted_for_ = std::move(suited.fitted_for);
  of_virtual_ = suited.of_virtual;
  device_ = std::move(suited.device);
  encoder_of_device_ = suited.encoder_of_device;
}

void Tuning::note_compensation() {
  const bool sliding = ImGui::GetCurrentContext() != nullptr && ImGui::IsAnyItemActive();
  if (!of_virtual_ || sliding) return;
  const OwnForces now = OwnForces::of(settings_.parameters());
  OwnForces& noted = devices_.hub().notes(device_).compensation;
  if (noted == now) return;
  noted = now;
  devices_.save();
}

void Tuning::analyze_anew() {
  analysed_.reset();
  follow_edited();
}

// Analyzes the edited settings if they are other ones, or of another arm: live and playback have
// their own.
void Tuning::follow_edited() {
  const Stage& shown = playback_.on() ? playback_.shown()->stage() : live_.stage();
  const Parameters p = playback_.on() ? edited() : live_.loop().taken(edited());
  if (analysed_ == p && analysed_stage_ == &shown) return;
  analysed_ = p;
  analysed_stage_ = &shown;
  analysis_ = analyze(shown.arm(), rest_pose(shown.arm()), p, std::nullopt);
}

void Tuning::update() {
  follow_lanes();
  const LaneParameters& now = settings_.lanes.parameters;
  for (std::size_t i = 0; i < settings_.lanes.count && !playback_.on(); ++i) {
    if (now[i] == marked_[i]) continue;
    mark_changes(now[i], marked_[i], i == kMainLane ? "" : lane_mark(i));
  }
  marked_ = now;
  follow_edited();
}

// Keeps all lanes on one hand, one device and one world, and names them in the plots.
void Tuning::follow_lanes() {
  LaneSettings& lanes = settings_.lanes;
  if (live_.loop().device_in_place()) lanes.count = 1;
  lanes.edited = std::min(lanes.edited, lanes.count - 1);
  share_world(lanes.parameters);
  live_.stage().name_runs(run_names(std::span(lanes.parameters).first(lanes.count)));
}

// Marks changes in the plots. Parameters that all lanes share are marked once.
void Tuning::mark_changes(const Parameters& now, const Parameters& before,
                          const std::string& whose) {
  for (const ParameterInfo* info : differing(now, before)) {
    if (!whose.empty() && !of_controller(*info)) continue;
    live_.mark(whose + mark_text(*info, now), whose + info->key);
  }
}

// Analyzes the recorded settings at the row that is shown.
void Tuning::follow_recorded(bool another) {
  PlayedSession* session = playback_.shown();
  if (session == nullptr || another) recorded_analysed_.reset();
  if (session == nullptr) return;
  if (another) of_rerun_ = session->began_with();
  const Parameters& now = session->settings();
  if (recorded_analysed_ && *recorded_analysed_ == now) return;
  recorded_analysed_ = now;
  const ArmDescription& arm = session->stage().arm();
  recorded_analysis_ = analyze(arm, rest_pose(arm), now, std::nullopt);
}

Tuning::Choices Tuning::choices() const {
  Settings now = settings_;
  end_passivity_break(now);
  if (of_virtual_) of_virtual_->give(now.parameters());
  return {now.lanes, fitted_for_};
}

void Tuning::take(const Choices& of_person) {
  settings_.lanes = of_person.lanes;
  if (fitted_for_ && of_person.fitted_for && fitted_for_->urdf != of_person.fitted_for->urdf) {
    for (Parameters& p : settings_.lanes.parameters) {
      refit(p, &*of_person.fitted_for, &*fitted_for_);
    }
  }
  if (!of_virtual_) return;
  Parameters& first = settings_.parameters();
  of_virtual_ = OfVirtualArm::of(first);
  devices_.hub().notes(device_).compensation.give(first);
  first.encoder_step = encoder_of_device_;
}

Settings Tuning::settings_to_keep(const Choices& of_person) const {
  Settings kept = settings_;
  kept.before_break.reset();
  kept.lanes = of_person.lanes;
  if (!of_person.fitted_for) return kept;
  for (Parameters& p : kept.lanes.parameters) refit(p, &*of_person.fitted_for, nullptr);
  return kept;
}

}  // namespace limpid
