#include "app/desktop/shell/sections.h"

#include <fmt/format.h>
#include <imgui.h>

#include <array>
#include <memory>

#include "app/desktop/coupling/analysis_panel.h"
#include "app/desktop/coupling/grip_panel.h"
#include "app/desktop/coupling/tick_panel.h"
#include "app/desktop/coupling/timing_panel.h"
#include "app/desktop/device/device_panel.h"
#include "app/desktop/scene/scene_panel.h"
#include "app/desktop/shell/desktop.h"
#include "app/desktop/widgets/parameter_rows.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"

namespace limpid {
namespace {

void say_for_rerun(const Desktop& d) {
  if (!d.playback.on()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(current_palette().muted));
  ImGui::TextWrapped(
      "These settings are for the re-run. The panel on the left shows the recorded ones.");
  ImGui::PopStyleColor();
}

std::string quality_text(const Desktop& d) {
  const std::string& wanted = d.settings.picture_quality;
  if (wanted != "automatic") return wanted;
  const int level = d.shown.quality_level();
  if (level == 0) return "automatic: best";
  if (level == Quality::kLowest) return "automatic: lowest";
  return fmt::format("automatic: {} below best", level);
}

DrawSection scene_section(Desktop& d) {
  return [&d, panel = std::make_shared<ScenePanel>()](const Act& act) {
    if (const PlayedSession* session = d.playback.shown()) {
      return ScenePanel::draw_recorded(session->document());
    }
    panel->draw(d.document, d.live.stage().arm(), d.live.recording(), act,
                [&d](Object object) { d.world.add_object(std::move(object)); });
  };
}

DrawSection hand_section(Desktop& d) {
  return [&d](const Act&) {
    say_for_rerun(d);
    const ArmDescription& arm = d.shown.stage().arm();
    draw_parameters(d.settings.parameters(), arm, {"hand.stiffness"});
    if (d.settings.everything) {
      draw_parameters(d.settings.parameters(), arm, {"hand.damping", "hand.mass"});
    }
    ImGui::Checkbox("hold where released", &d.settings.hold_on_release);
    tooltip(
        "When you release the mouse button, the hand stays where it is and does not let go of the "
        "arm.");
    if (d.playback.on()) return;
    draw_grip(d.live.grip(), d.live.stage().arm(), d.document.scene(), d.settings.parameters());
  };
}

bool with_device(const Desktop& d) { return !d.devices.hub().in_use().empty(); }

DrawSection device_section(Desktop& d) {
  return [&d](const Act&) {
    Parameters& parameters = d.settings.parameters();
    const ArmDescription& arm = d.shown.stage().arm();
    const DeviceCardAsks asks =
        draw_device_panel(d.devices, d.live, {d.pads.all(), d.settings.gamepad}, parameters);
    if (asks.identify) d.dialog.open("identify");
    if (asks.arm_file) d.dialog.open("device arm");
    say_for_rerun(d);
    // Nothing beside a device acts on the virtual arm.
    if (!with_device(d)) {
      draw_parameters(
          parameters, arm,
          {"device.gravity", "device.springs", "model.gravity", "model.springs", "model.friction"});
    }
    draw_parameters(parameters, arm,
                    {"device.torque_limit", "observer.anti_windup", "device.damping",
                     "device.friction", "device.encoder_step", "device.delay", "model.delay",
                     "observer.velocity", "model.inertia_error", "proxy.inertia_ratio"});
  };
}

DrawSection imperfections_section(Desktop& d) {
  return [&d](const Act&) {
    if (with_device(d)) {
      return ImGui::TextWrapped(
          "These settings belong to the virtual arm. The device in use has its own values.");
    }
    ImGui::TextWrapped(
        "Errors of the virtual arm's motors and encoders. No law knows these errors.");
    say_for_rerun(d);
    draw_parameters(d.settings.parameters(), d.shown.stage().arm(),
                    {"plant.torque_scale", "plant.current_loop", "plant.resonance", "plant.cogging",
                     "plant.friction", "plant.eccentricity", "plant.zero"});
  };
}

DrawSection analysis_section(Desktop& d) {
  return [&d, panel = std::make_shared<AnalysisPanel>()](const Act&) {
    const Stage& shown = d.shown.stage();
    const auto pose = shown.channels().layout().in(d.shown.row(), Column::device_position);
    PlayedSession* session = d.playback.shown();
    const Scene& scene = session ? session->document().scene : d.document.scene();
    panel->draw(session ? session->settings() : d.live.loop().taken(d.tuning.edited()), shown.arm(),
                scene, pose, d.settings.band);
  };
}

DrawSection timing_section(Desktop& d) {
  return [&d, of_device = std::make_shared<DeviceTiming>()](const Act&) {
    const LiveLoop& loop = d.live.loop();
    draw_timing(loop, quality_text(d), d.frame_time);
    if (!loop.device_in_place()) return;
    of_device->draw(loop.device_pace(), d.live.stage().arm(), loop.taken(d.settings.parameters()),
                    d.document.scene(), loop.layout().in(d.live.row(), Column::device_position));
  };
}

DrawSection tick_section(Desktop& d) {
  return [&d](const Act&) { draw_tick(d.shown.stage(), d.shown.row()); };
}

bool always(const Desktop&) { return true; }
bool never(const Desktop&) { return false; }
bool with_any_device(const Desktop& d) {
  return with_device(d) || !d.devices.hub().found().empty() || !d.pads.all().empty();
}

constexpr std::array kSections{
    SectionKind{"Scene", always, scene_section, always},
    SectionKind{"Hand", always, hand_section, always},
    SectionKind{"Device", with_device, device_section, with_any_device},
    SectionKind{"Imperfections", never, imperfections_section, never},
    SectionKind{"Analysis", never, analysis_section, never},
    SectionKind{"This tick", never, tick_section, never},
    SectionKind{"Timing", always, timing_section, never},
};

}  // namespace

Sections::Sections(Desktop& desktop) : desktop_(desktop) {
  for (const SectionKind& kind : kSections) drawn_.emplace_back(&kind, kind.make(desktop));
}

void Sections::draw(const Act& act) {
  // A device that is in use comes first: nothing of it is below the fold.
  const bool device = with_device(desktop_);
  if (std::exchange(device_first_, device) != device && device) ImGui::SetScrollY(0);
  for (const bool first : {true, false}) {
    for (const auto& [kind, draw_it] : drawn_) {
      if ((device && kind->make == device_section) != first) continue;
      if (!desktop_.settings.everything && !kind->simple(desktop_)) continue;
      if (section(kind->title, kind->open(desktop_))) draw_it(act);
    }
  }
}

}  // namespace limpid
