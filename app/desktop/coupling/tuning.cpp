#include "app/desktop/coupling/tuning.h"

#include <fmt/format.h>
#include <imgui.h>

#include "app/base/folders.h"
#include "app/desktop/base/passivity_break.h"
#include "app/desktop/base/window_layout.h"
#include "app/run/fitted_gains.h"
#include "app/run/twin_settings.h"
#include "app/style/words.h"
#include "core/dynamics/arm.h"
#include "devices/files/config_file.h"

namespace limpid {

Tuning::Tuning(Settings& settings, Notices& notices, LiveSession& live, DeviceController& devices,
               Playback& playback)
    : presets(data_dir() / "assets/presets.toml", user_config_dir() / "presets.toml"),
      settings_(settings),
      notices_(notices),
      live_(live),
      devices_(devices),
      playback_(playback),
      analysed_(settings.parameters),
      analysed_twin_(settings.twin.parameters) {}

Parameters& Tuning::edited() {
  return edits_twin() ? settings_.twin.parameters : settings_.parameters;
}

void Tuning::next_law() {
  if (passivity_broken(settings_)) return end_break();
  Parameters& p = edited();
  p.kind = next(p.kind);
  while (info(p.kind).for_links && !p.linked()) p.kind = next(p.kind);
}

void Tuning::toggle_twin() {
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

void Tuning::break_passivity() { limpid::break_passivity(settings_, live_.stage().arm()); }

void Tuning::end_break() {
  if (!passivity_broken(settings_)) return;
  end_passivity_break(settings_);
  notices_.say(kBreakEnded);
}

void Tuning::reset() {
  end_break();
  settings_.parameters = fitted(live_.stage().arm());
  const bool usual = settings_.parameters == Parameters{};
  notices_.say(usual
                   ? "All settings have their usual values again, the paper's where it gives them."
                   : "All settings have their usual values again, with gains fitted to this arm.");
}

void Tuning::use_preset(const std::string& name) {
  const NamedTexts::Entry* preset = presets.find(name);
  if (preset == nullptr) return;
  end_break();
  apply_preset(edited(), preset->text, name);
  notices_.say(fmt::format("Settings: {}. Ctrl+Z brings back what was before.", name));
}

// Fits the gains, as those for the arm before may be far too stiff. A device's compensation of its
// own weight is remembered with the device, and no later arm gets it.
Tuning::Suited Tuning::suited(const ArmDescription& arm, const DeviceTraits* device) const {
  Suited s{settings_.parameters, settings_.twin.parameters, fitted_for_, of_virtual_, device_,
           encoder_of_device_};
  if (!s.fitted_for || s.fitted_for->urdf != arm.urdf) {
    const ArmDescription* before = fitted_for_ ? &*fitted_for_ : nullptr;
    refit(s.first, before, &arm);
    refit(s.twin, before, &arm);
    s.fitted_for = arm;
  }
  const OfVirtualArm of_virtual = s.of_virtual ? *s.of_virtual : OfVirtualArm::of(s.first);
  s.of_virtual.reset();
  of_virtual.give(s.first);
  if (device == nullptr) return s;
  s.of_virtual = of_virtual;
  s.device = devices_.hub().in_use();
  devices_.hub().notes(s.device).compensation.give(s.first);
  s.first.encoder_step = s.encoder_of_device = encoder_step_of(*device);
  return s;
}

void Tuning::take(Suited suited) {
  settings_.parameters = suited.first;
  settings_.twin.parameters = suited.twin;
  fitted_for_ = std::move(suited.fitted_for);
  of_virtual_ = suited.of_virtual;
  device_ = std::move(suited.device);
  encoder_of_device_ = suited.encoder_of_device;
}

void Tuning::note_compensation() {
  const bool sliding = ImGui::GetCurrentContext() != nullptr && ImGui::IsAnyItemActive();
  if (!of_virtual_ || sliding) return;
  const OwnForces now = OwnForces::of(settings_.parameters);
  OwnForces& noted = devices_.hub().notes(device_).compensation;
  if (noted == now) return;
  noted = now;
  devices_.save();
}

void Tuning::analyze_anew() {
  const ArmDescription& arm = live_.stage().arm();
  analysis_ = analyze(arm, rest_pose(arm), live_.loop().taken(settings_.parameters), std::nullopt);
}

void Tuning::update() {
  follow_twin();
  const Parameters &first = settings_.parameters, &twin = settings_.twin.parameters;
  const bool changed = !(first == analysed_) || !(twin == analysed_twin_);
  if (!changed && analysed_of_twin_ == edits_twin()) return;
  if (!playback_.on()) {
    mark_changes(first, analysed_, "");
    if (settings_.twin.on) mark_changes(twin, analysed_twin_, std::string(kTwinMark));
  }
  analysed_ = first;
  analysed_twin_ = twin;
  analysed_of_twin_ = edits_twin();
  const Stage& shown = playback_.on() ? playback_.shown()->stage() : live_.stage();
  const Parameters p = playback_.on() ? edited() : live_.loop().taken(edited());
  analysis_ = analyze(shown.arm(), rest_pose(shown.arm()), p, std::nullopt);
}

// Keeps both runs on one hand, one device and one world, and names them in the plots.
void Tuning::follow_twin() {
  TwinSettings& twin = settings_.twin;
  if (live_.loop().device_in_place()) twin.on = false;
  share_world(settings_.parameters, twin.parameters);
  if (!twin.on) return live_.stage().name_runs({});
  const auto names = twin_names(settings_.parameters, twin.parameters);
  live_.stage().name_runs(
      {names[0],
       names[1],
       true,
       {static_cast<int>(settings_.parameters.kind), static_cast<int>(twin.parameters.kind)}});
}

// Marks changes in the plots. Parameters that both runs share are marked once.
void Tuning::mark_changes(const Parameters& now, const Parameters& before,
                          const std::string& whose) {
  for (const ParameterInfo& info : parameter_table()) {
    if (parameter_text(now, info) == parameter_text(before, info)) continue;
    if (!whose.empty() && !of_controller(info)) continue;
    live_.mark(whose + mark_text(info, now), whose + info.key);
  }
}

// Analyzes the recorded settings at the row that is shown.
void Tuning::follow_recorded(bool another) {
  PlayedSession* session = playback_.shown();
  if (session == nullptr || another) recorded_analysed_.reset();
  if (session == nullptr) return;
  const Parameters& now = session->settings();
  if (recorded_analysed_ && *recorded_analysed_ == now) return;
  recorded_analysed_ = now;
  const ArmDescription& arm = session->stage().arm();
  recorded_analysis_ = analyze(arm, rest_pose(arm), now, std::nullopt);
}

Tuning::Choices Tuning::choices() const {
  Settings now = settings_;
  end_passivity_break(now);
  if (of_virtual_) of_virtual_->give(now.parameters);
  return {now.parameters, now.twin, fitted_for_};
}

void Tuning::take(const Choices& of_person) {
  Parameters& first = settings_.parameters;
  first = of_person.first;
  settings_.twin = of_person.twin;
  if (fitted_for_ && of_person.fitted_for && fitted_for_->urdf != of_person.fitted_for->urdf) {
    refit(first, &*of_person.fitted_for, &*fitted_for_);
    refit(settings_.twin.parameters, &*of_person.fitted_for, &*fitted_for_);
  }
  if (!of_virtual_) return;
  of_virtual_ = OfVirtualArm::of(first);
  devices_.hub().notes(device_).compensation.give(first);
  first.encoder_step = encoder_of_device_;
}

Settings Tuning::settings_to_keep(const Choices& of_person) const {
  Settings kept = settings_;
  kept.before_break.reset();
  kept.parameters = of_person.first;
  kept.twin = of_person.twin;
  if (!of_person.fitted_for) return kept;
  refit(kept.parameters, &*of_person.fitted_for, nullptr);
  refit(kept.twin.parameters, &*of_person.fitted_for, nullptr);
  return kept;
}

}  // namespace limpid
