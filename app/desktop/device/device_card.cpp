#include "app/desktop/device/device_card.h"

#include <fmt/format.h>
#include <imgui.h>

#include <cmath>

#include "app/desktop/device/push_sketch.h"
#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/run/motor_limits.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "app/style/words.h"

namespace limpid {
namespace {

// Draws a step's mark and its title; what follows stands indented below it.
void begin_step(StepState state, const char* title, const std::string& value) {
  const Palette& colours = current_palette();
  const float em = ImGui::GetFontSize(), r = 0.38f * em;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 middle(at.x + r, at.y + 0.5f * ImGui::GetTextLineHeight());
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const Rgb rgb = state == StepState::failed  ? colours.broken
                  : state == StepState::later ? colours.axis
                                              : colours.accent;
  if (state == StepState::done) {
    list.AddCircleFilled(middle, r, colour(rgb));
    const ImU32 tick = colour(colours.panel);
    list.AddLine({middle.x - 0.5f * r, middle.y}, {middle.x - 0.1f * r, middle.y + 0.4f * r}, tick,
                 0.12f * em);
    list.AddLine({middle.x - 0.1f * r, middle.y + 0.4f * r},
                 {middle.x + 0.5f * r, middle.y - 0.4f * r}, tick, 0.12f * em);
  } else {
    list.AddCircle(middle, r, colour(rgb), 0, 0.12f * em);
    if (state == StepState::now) list.AddCircleFilled(middle, 0.5f * r, colour(rgb));
    if (state == StepState::failed) {
      list.AddLine({middle.x, middle.y - 0.5f * r}, {middle.x, middle.y + 0.1f * r}, colour(rgb),
                   0.14f * em);
      list.AddCircleFilled({middle.x, middle.y + 0.5f * r}, 0.09f * em, colour(rgb));
    }
  }
  ImGui::Indent(1.3f * em);
  const Rgb ink = state == StepState::later ? colours.muted : colours.text;
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(ink));
  ImGui::TextWrapped("%s%s%s", title, value.empty() ? "" : ": ", value.c_str());
  if (!value.empty()) note_place(title);
  ImGui::PopStyleColor();
}

void end_step() { ImGui::Unindent(1.3f * ImGui::GetFontSize()); }

void say_problem(const DeviceController& devices) {
  if (devices.problem().empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(current_palette().broken));
  ImGui::TextWrapped("%s", devices.problem().c_str());
  ImGui::PopStyleColor();
}

void draw_found(DeviceController& devices, StepState state) {
  const FoundDevice* found = devices.hub().present();
  begin_step(state, "Found", found != nullptr ? found->place.name : "not plugged in");
  if (state != StepState::done) say_problem(devices);
  const std::string missing = found != nullptr ? found->missing : std::string();
  const std::size_t from = missing.find('\''), to = missing.rfind('\'');
  if (devices.waits_for_choice() && ImGui::Button("Connect to it")) {
    devices.use(devices.hub().in_use());
  }
  if (from < to && ImGui::SmallButton("copy the command")) {
    ImGui::SetClipboardText(missing.substr(from + 1, to - from - 1).c_str());
  }
  end_step();
}

// Asks which arm the device is; returns true if a file is to be chosen.
bool draw_arm(DeviceController& devices, const LiveStage& live, StepState state) {
  const DeviceHub& hub = devices.hub();
  const bool in_place = live.loop().device_in_place();
  const bool asks = hub.may_say_arm() && hub.asks_for_arm();
  begin_step(state, "Its arm", in_place && !asks ? live.stage().arm().name : std::string());
  tooltip("The joint ranges and link lengths of this arm set the limits of the force.");
  bool file = false;
  if (asks) {
    ImGui::TextWrapped(
        "Which arm is this device? Until you choose an arm, Limpid uses a built-in arm with little "
        "force.");
    tooltip(
        "No built-in arm has more than three joints. A device with more joints gets no force until "
        "you choose its arm.");
    if (noted_button(kBuiltInArmButton)) devices.say_arm({kBuiltInArm, ""});
    tooltip(
        "Uses paddle.urdf, joystick.urdf or omni.urdf of assets/devices, depending on the number "
        "of the device's joints.");
    flow(kOpenArmButton);
    const NamedArm open = devices.open_arm();
    if (noted_button(kOpenArmButton)) devices.say_arm(open);
    tooltip(open.file.c_str());
    flow(kArmOfFileButton);
    file = noted_button(kArmOfFileButton);
  } else if (hub.may_say_arm()) {
    if (ImGui::SmallButton("Another arm...")) devices.say_arm({});
    tooltip("Asks again which arm this device is.");
  }
  end_step();
  return file;
}

// Draws the guided check of a new device's axes.
void draw_axes(DeviceController& devices, StepState state) {
  const AxisCheckProgress* check = devices.check();
  begin_step(state, "Its axes",
             check != nullptr           ? fmt::format("checking axis {}", check->axis + 1)
             : state == StepState::done ? "move as they are pushed"
                                        : "");
  if (check != nullptr) {
    const AxisStage stage = check->stage;
    if (check->begun && draw_push_sketch(check->arm, check->axis, stage)) {
      flow(8 * ImGui::GetFontSize());
    }
    ImGui::TextWrapped("%s", what_to_do(stage));
    if (ImGui::Button("Stop (Esc)")) devices.cancel_check();
  } else if (state != StepState::later && devices.awaits_check()) {
    ImGui::TextWrapped("%s", devices.problem().c_str());
    if (noted_button(kCheckAxes)) devices.start_check();
    tooltip(
        "Pushes each axis with a tenth of the force to see whether the axis moves, and in which "
        "direction. Let go of the device. Esc stops the check.");
  }
  end_step();
}

// Draws measured and assumed values of the device, and the delay that the law calculates with.
// Returns true if the user wants more measured.
bool draw_measured(DeviceController& devices, Parameters& p, StepState state) {
  const DeviceNotes& notes = devices.hub().notes(devices.hub().in_use());
  const bool found = !notes.arm.empty();
  begin_step(state, "Inertia, friction, delay",
             state == StepState::later ? ""
             : found                   ? "measured"
                                       : "assumed");
  tooltip(
      "Measured: values that `limpid identify` measured and saved for this device. Assumed: values "
      "from the arm's file. Condition (3), \xCE\xB7_min and the walls in the analysis are computed "
      "from these values.");
  if (state == StepState::later) {
    end_step();
    return false;
  }
  if (notes.torque_scale != 1) {
    read_out(
        "motors", fmt::format("give {:.3f} of the commanded torque", notes.torque_scale), {},
        "Measured with a load at the tip. Commands to the motors are corrected by this factor.");
  }
  const bool wanted = ImGui::Button(found ? "Identify again..." : "Identify...");
  tooltip("Moves the device by itself and measures inertia, friction, weight and delay.");
  if (std::isnan(notes.delay)) {
    read_out("delay", "not measured", {}, "Identify the device to measure the delay.");
  } else {
    read_out("delay", fmt::format("{:.1f} ms, measured", 1e3 * notes.delay), {},
             "Delay from a reading to the torque computed from it. The tick is not included.");
    const Parameters with = reckoning_with(p, notes.delay);
    const std::string text =
        fmt::format("Calculate with {} tick{} of delay", with.delay, with.delay == 1 ? "" : "s");
    if (with.delay != p.delay && ImGui::Button(text.c_str())) p = with;
    tooltip(
        fmt::format("The predictive law calculates with a delay of {} now (model.delay, in ticks).",
                    p.delay)
            .c_str());
  }
  end_step();
  return wanted;
}

// Says why force is off, or less than usual.
void draw_force(const LiveStage& live, const Parameters& p, StepState state) {
  const LiveLoop& loop = live.loop();
  const bool in_place = loop.device_in_place();
  begin_step(state, "Force", in_place ? explain(loop.snapshot().force_state) : "");
  tooltip(
      "Force is off until the hand holds the device and you switch the force on with key F. The "
      "force then fades in.");
  const std::string words = in_place ? device_words(loop.snapshot().reading) : std::string();
  if (!words.empty()) ImGui::TextWrapped("%s", words.c_str());
  const std::string warm = warm_text(live.stage().arm(), loop.taken(p), loop.layout(), live.row());
  if (!warm.empty()) ImGui::TextWrapped("%s", warm.c_str());
  end_step();
}

DeviceSituation situation_of(DeviceController& devices, const LiveLoop& loop) {
  const FoundDevice* found = devices.hub().present();
  // A device that was pulled out keeps its place, and a look may miss one that answers.
  const bool there = loop.snapshot().connected || found != nullptr;
  const bool in_place = loop.device_in_place() && there;
  return {.present = found != nullptr && found->missing.empty(),
          .asks_for_arm = devices.hub().may_say_arm() && devices.hub().asks_for_arm(),
          .checking = devices.check() != nullptr,
          .check_failed = devices.check_failed(),
          .awaits_check = there && devices.awaits_check(),
          .in_place = in_place,
          .measured = !devices.hub().notes(devices.hub().in_use()).arm.empty(),
          .pushes = in_place && loop.snapshot().arming == Arming::on,
          .problem = !devices.problem().empty()};
}

}  // namespace

DeviceSteps steps_of(const DeviceSituation& of) {
  using enum StepState;
  DeviceSteps steps;
  const bool at_axes = of.checking || of.awaits_check;
  const bool opens = of.present && !of.problem;
  const bool there = of.in_place || at_axes;
  steps.found = there || opens ? done : of.problem ? failed : now;
  if (steps.found != done) return steps;
  steps.arm = of.asks_for_arm ? now : there ? done : later;
  if (at_axes) steps.axes = of.check_failed && !of.checking ? failed : now;
  if (!of.in_place) return steps;
  steps.axes = done;
  steps.measured = of.measured ? done : now;
  steps.force = of.pushes ? done : now;
  return steps;
}

Parameters reckoning_with(Parameters p, double delay) {
  set_parameter_number(p, *find_parameter("model.delay"), delay / p.tick);
  return p;
}

DeviceCardAsks draw_device_card(DeviceController& devices, const LiveStage& live, Parameters& p) {
  DeviceCardAsks asks;
  const DeviceSteps steps = steps_of(situation_of(devices, live.loop()));
  draw_found(devices, steps.found);
  asks.arm_file = draw_arm(devices, live, steps.arm);
  draw_axes(devices, steps.axes);
  asks.identify = draw_measured(devices, p, steps.measured);
  draw_force(live, p, steps.force);
  return asks;
}

}  // namespace limpid
