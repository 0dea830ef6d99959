#include "app/desktop/device/device_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/parameter_rows.h"
#include "app/desktop/widgets/widgets.h"
#include "app/run/fitted_gains.h"
#include "app/style/imgui_input.h"
#include "app/style/palette.h"
#include "app/style/range_reminder.h"
#include "app/style/theme.h"
#include "app/style/words.h"
#include "core/dynamics/arm_description.h"

namespace limpid {
namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;
constexpr std::size_t kAxesOfACap = 6;

void choice(DeviceController& devices, const char* label, const std::string& id, const char* help) {
  if (ImGui::RadioButton(label, devices.hub().in_use() == id)) devices.use(id);
  tooltip(help);
}

// Draws the choice of the mouse, or of a gamepad, for the virtual arm's hand; the mouse can always
// lead it.
void hand_choice(DeviceController& devices, const PadChoice& pads, const std::string& label,
                 const std::string& id, const char* help) {
  ImGui::PushID(id.c_str());
  if (ImGui::RadioButton(label.c_str(), devices.hub().in_use().empty() && pads.chosen == id)) {
    pads.chosen = id;
    if (!devices.hub().in_use().empty()) devices.use("");
  }
  tooltip(help);
  ImGui::PopID();
}

void hand_choices(DeviceController& devices, const PadChoice& pads) {
  hand_choice(devices, pads, "virtual arm, by the mouse", "",
              "A simulated arm. You move it with the mouse.");
  bool known = pads.chosen.empty();
  for (const Pad& pad : pads.pads) {
    hand_choice(devices, pads, "virtual arm, by " + pad.name, pad.id,
                "Left stick: moves the hand in the plane of the picture. Triggers or right stick: "
                "move the hand nearer and farther. A: takes hold of the arm or lets it go. B: "
                "switches the force off. Y: next coupling.");
    known = known || pad.id == pads.chosen;
  }
  if (known) return;
  hand_choice(
      devices, pads, "virtual arm, moved by the gamepad used last", pads.chosen,
      "The last gamepad is not plugged in. The mouse moves the hand until the gamepad is back.");
}

void choices(DeviceController& devices, const PadChoice& pads) {
  hand_choices(devices, pads);
  bool known = devices.hub().in_use().empty();
  for (const FoundDevice& found : devices.hub().found()) {
    std::string help = found.missing.empty()
                           ? fmt::format("{}, {}", found.kind->name, found.place.id)
                           : found.missing;
    if (!found.in_use_by.empty()) help += fmt::format("\nIn use by {}.", found.in_use_by);
    ImGui::PushID(found.place.path.c_str());
    choice(devices, found.place.name.c_str(), found.place.id, help.c_str());
    ImGui::PopID();
    known = known || found.place.id == devices.hub().in_use();
  }
  if (!known)
    choice(devices, "the last device", devices.hub().in_use(),
           "The last device is not plugged in.");
  if (known && devices.hub().found().empty()) {
    ImGui::TextWrapped("No haptic device is plugged in.");
    tooltip(
        "A device stands here as soon as Limpid finds it. `limpid doctor` says what is missing for "
        "a device. The manual (menu Help) lists the devices that Limpid supports, and a "
        "simulated device to try.");
  }
}

// Draws which part of the device's own forces the motors compensate.
void compensation(const ArmDescription& arm, Parameters& p) {
  if (!section("Compensation", true)) return;
  tooltip(
      "Forces of the device itself (weight, springs, friction) that the motors can cancel, so that "
      "the hand does not feel them. This compensation starts, fades and stops together with all "
      "other force.");
  const CompensationSettings wanted = suggested_compensation(arm);
  CompensationSettings& now = p;
  if (arm.delay && now != wanted) {
    if (ImGui::Button("Cancel the measured forces")) now = wanted;
    tooltip(fmt::format("Weight {}, springs {}, {:.0f} % of the friction.",
                        wanted.holds_weight ? "held" : "not there",
                        wanted.holds_springs ? "held" : "not there", 100 * wanted.friction_share)
                .c_str());
  }
  double friction = 0, spring = 0;
  for (const Joint& joint : arm.joints) {
    friction = std::max(friction, joint.friction);
    spring = std::max({spring, std::abs(joint.spring), std::abs(joint.offset)});
  }
  draw_parameters(p, arm, {"model.gravity"});
  if (p.holds_weight) draw_parameters(p, arm, {"device.down"});
  const auto where_there = [&](const char* key, bool there, const char* none) {
    if (there) return draw_parameters(p, arm, {key});
    read_out(find_parameter(key)->caption, none, {},
             "`limpid identify` measures weight, springs and friction.");
  };
  where_there("model.springs", spring > 0, "none known");
  where_there("model.friction", friction > 0, "no friction known");
}

// Draws a number's slider, with room for `letters` behind it; returns true once it was changed.
template <class Owner>
bool settled_slider(const Field<Owner>& field, Owner& owner, float letters) {
  const double shown = std::string_view(field.unit) == "rad" ? kDegrees : 1;
  const std::string format = shown != 1
                                 ? "\xC2\xB1%.0f\xC2\xB0"
                                 : fmt::format("%.3g {}", field.has_unit() ? field.unit : "");
  const bool own = field.slider_maximum > field.slider_minimum;
  const double least = own ? field.slider_minimum : field.minimum,
               most = own ? field.slider_maximum : field.maximum;
  auto value = static_cast<float>(shown * number_of(field, owner));
  const auto low = static_cast<float>(shown * least), high = static_cast<float>(shown * most);
  ImGui::SetNextItemWidth(-letters * ImGui::GetFontSize());
  const bool changed = ImGui::SliderFloat(field.caption, &value, low, high, format.c_str(),
                                          field.logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  note_number_item();
  const bool settled = ImGui::IsItemDeactivatedAfterEdit();
  tooltip(field.meaning);
  const bool taken = counts(ImGui::GetID(field.caption), changed, value >= low && value <= high,
                            fmt::format("{:g} to {:g}", low, high));
  if (taken) set_number(field, owner, static_cast<double>(value) / shown);
  return settled && (taken || !changed);
}

// Draws a joint of the arm, or an axis of a cap, which has no joint: angle, direction, travel and
// zero.
bool axis_row(AxisAdjustment& axis, std::size_t i, double angle, const Joint* joint) {
  bool changed = false;
  ImGui::PushID(static_cast<int>(i));
  if (joint == nullptr) {  // shown as part of the cap's full deflection
    ImGui::Text("axis %zu  %+5.2f", i + 1, angle);
    ImGui::SameLine(8.5f * ImGui::GetFontSize());
    changed = ImGui::Checkbox("invert", &axis.inverted);
    ImGui::PopID();
    return changed;
  }
  ImGui::AlignTextToFramePadding();
  const bool slides = joint->kind == Joint::Kind::prismatic;
  ImGui::Text(slides ? "axis %zu  %+7.1f mm" : "axis %zu  %+7.2f\xC2\xB0", i + 1,
              angle * (slides ? 1e3 * kSlideUnit : kDegrees));
  ImGui::SameLine(8.5f * ImGui::GetFontSize());
  changed = ImGui::Checkbox("invert", &axis.inverted) || changed;
  tooltip("Reverses the sign of the axis and of its torque.");
  flow("reverse force");
  changed = ImGui::Checkbox("reverse force", &axis.reversed) || changed;
  tooltip(
      "Reverses a motor that pushes in the wrong direction. The check of the axes finds such a "
      "motor by itself. After a change here the axes are checked again, because with the wrong "
      "sign the loop is unstable.");
  flow("zero here");
  if (ImGui::SmallButton("zero here")) {
    axis.zero += angle / axis.factor();
    changed = true;
  }
  tooltip("The present position becomes zero.");
  changed = settled_slider(*find_field(kAxisFields, "scale"), axis, 4.5f) || changed;
  ImGui::PopID();
  return changed;
}

// Returns true once the settings were changed.
bool joystick_settings(DeviceNotes& notes) {
  const double effort = notes.pid.effort;
  bool changed = false;
  for (const auto& field : kPidFields) changed = settled_slider(field, notes.pid, 7) || changed;
  if (notes.pid.effort != effort)
    notes.torque_scale = 1;  // the old one was found with the other effort
  return changed;
}

// Returns true once a limit was changed.
bool limit_sliders(SafetyLimits& limits) {
  if (!ImGui::TreeNode("Limits of force")) return false;
  tooltip("You can lower these limits for this device. The first values are the largest allowed.");
  bool changed = false;
  for (const auto& limit : kSafetyLimits) changed = settled_slider(limit, limits, 9) || changed;
  ImGui::TreePop();
  return changed;
}

// Returns true once an axis was changed.
bool axis_rows(DeviceNotes& notes, std::span<const double> angles, std::span<const Joint> joints) {
  std::vector<AxisAdjustment> axes = notes.axes;
  axes.resize(std::max(axes.size(), angles.size()));
  const std::vector<AxisAdjustment> before = axes;
  bool changed = false;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const Joint* joint = joints.empty() ? nullptr : &joints[i];
    changed = axis_row(axes[i], i, angles[i], joint) || changed;
  }
  if (axes == before) return changed;
  if (!std::ranges::equal(before, axes, {}, &AxisAdjustment::reversed, &AxisAdjustment::reversed)) {
    notes.checked = false;
  }
  notes.axes = axes;
  return changed;
}

void adjustments(DeviceController& devices, const LiveStage& live) {
  const FoundDevice* found = devices.hub().present();
  if (found == nullptr || !live.loop().device_plugged()) return;
  const bool in_place = live.loop().device_in_place();
  std::span<const Joint> joints;
  if (in_place) joints = live.stage().arm().joints;
  const std::size_t count = in_place ? joints.size() : kAxesOfACap;
  DeviceNotes& notes = devices.hub().notes(devices.hub().in_use());
  const NotesEdited edited =
      draw_notes(notes, std::span(live.loop().snapshot().reading.x).first(count), joints,
                 found->kind->uncalibrated, live.recording());
  if (edited.anew) {
    devices.connect_anew();
  } else if (edited.limits) {
    devices.save();
  }
}

}  // namespace

NotesEdited draw_notes(DeviceNotes& notes, std::span<const double> angles,
                       std::span<const Joint> joints, bool uncalibrated, bool limits_fixed) {
  NotesEdited edited;
  edited.anew = axis_rows(notes, angles, joints);
  if (uncalibrated) edited.anew = joystick_settings(notes) || edited.anew;
  if (joints.empty()) return edited;
  ImGui::BeginDisabled(limits_fixed);
  edited.limits = limit_sliders(notes.limits);
  ImGui::EndDisabled();
  return edited;
}

DeviceCardAsks draw_device_panel(DeviceController& devices, const LiveStage& live,
                                 const PadChoice& pads, Parameters& p) {
  DeviceCardAsks asks;
  choices(devices, pads);
  if (!devices.hub().in_use().empty()) {
    ImGui::Spacing();
    asks = draw_device_card(devices, live, p);
    if (live.loop().device_in_place()) compensation(live.stage().arm(), p);
    adjustments(devices, live);
  }
  ImGui::Separator();
  return asks;
}

}  // namespace limpid
