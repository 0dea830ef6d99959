#include "app/desktop/device/identify_dialog.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "app/base/open_elsewhere.h"
#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/imgui_input.h"
#include "app/style/palette.h"
#include "app/style/range_reminder.h"
#include "app/style/theme.h"
#include "app/style/words.h"

namespace limpid {
namespace {

using Phase = IdentifyController::Phase;

constexpr const char* kTitle = "Identify the device";
constexpr const char* kWithLoad = "identify again with a load at the tip";
constexpr const char* kLoad = "load";
constexpr const char* kGoOn = "Go on (Enter)";
constexpr const char* kAgain = "Again";
constexpr float kLabels = 14;  // width of the labels [text sizes]
constexpr std::array kDownLabels{"as the arm's file says", "-z", "+z", "-x", "+x", "-y", "+y"};

void muted(const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(palette(current_theme()).muted));
  ImGui::TextWrapped("%s", text.c_str());
  ImGui::PopStyleColor();
}

// Draws a slider for a part of something, in per cent.
void part_slider(const char* label, double& part, float least, float most, const char* help) {
  auto per_cent = static_cast<float>(100 * part);
  ImGui::SetNextItemWidth(-kLabels * ImGui::GetFontSize());
  const bool changed = ImGui::SliderFloat(label, &per_cent, 100 * least, 100 * most, "%.0f %%");
  note_number_item();
  tooltip(help);
  const bool inside = per_cent >= 100 * least && per_cent <= 100 * most;
  if (counts(ImGui::GetID(label), changed, inside,
             fmt::format("{:.0f} to {:.0f} %", 100 * least, 100 * most))) {
    part = static_cast<double>(per_cent) / 100;
  }
}

std::string going_on(const IdentifyProgress& progress, const ArmDescription& arm) {
  switch (progress.stage) {
    case ExcitationStage::approach: return "it goes to the middle of its range";
    case ExcitationStage::sweep:
      return fmt::format("joint {} slowly, to measure its friction",
                         arm.joints[static_cast<std::size_t>(progress.joint)].name);
    case ExcitationStage::shake:
      return "all joints at the same time, to measure inertia, weight and delay";
    case ExcitationStage::fade: return "it comes to rest";
  }
  return {};
}

void draw_motion(IdentifyController& controller, const ArmDescription& arm) {
  const IdentifyProgress& progress = controller.progress();
  ImGui::TextWrapped("The motors move the device now: %s.", going_on(progress, arm).c_str());
  progress_bar(std::clamp(progress.time / progress.duration, 0.0, 1.0),
               ImGui::GetContentRegionAvail().x);
  muted("If you hold the device, the identification stops, too.");
  if (ImGui::Button("Stop (Esc)")) controller.stop();
}

void draw_load(IdentifyController& controller, double load) {
  ImGui::TextWrapped("Now fix the %.0f g to the tip, firmly and close to the tip. Then let go.",
                     1e3 * load);
  if (controller.simulated())
    muted(
        "You need no real load. When you press Go on, the simulated device gets this mass at its "
        "tip.");
  if (noted_button(kGoOn) || accepted()) controller.go_on();
  ImGui::SameLine();
  if (ImGui::Button("Stop (Esc)")) controller.stop();
}

void joints_table(const Identification& identification) {
  const Identified& found = identification.found;
  const auto columns = static_cast<int>(found.joints.size()) + 1;
  if (!ImGui::BeginTable("found", columns, ImGuiTableFlags_BordersInnerH)) return;
  ImGui::TableSetupColumn("");
  for (const Joint& joint : found.arm.joints) ImGui::TableSetupColumn(joint.name.c_str());
  ImGui::TableHeadersRow();
  const auto row = [&](const std::string& label, const auto& text) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(label.c_str());
    for (std::size_t j = 0; j < found.joints.size(); ++j) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(text(j).c_str());
    }
  };
  row("inertia in its file [g m^2]", [&](std::size_t j) {
    return fmt::format("{:.3f}", identification.inertia_in_file[j] / 1e-3);
  });
  for (const FindingInfo& info : kFindings) {
    row(fmt::format("{} [{}]", info.label, info.unit), [&](std::size_t j) {
      return with_plus_minus(text_of(found.joints[j].*info.field, info.per_unit));
    });
  }
  row("not explained", [&](std::size_t j) {
    return fmt::format("{:.1f} %", 100 * found.joints[j].residual / found.joints[j].torque);
  });
  ImGui::EndTable();
}

void draw_drift(const std::vector<Drift>& all) {
  if (all.empty()) return;
  std::string text;
  for (const Drift& d : all) {
    if (!d.certain) continue;
    text += fmt::format("{}{}: {} \xE2\x86\x92 {} {}", text.empty() ? "" : "\n", d.what,
                        text_of(d.before, 1), text_of(d.now, 1), d.unit);
  }
  if (text.empty()) return muted("No value has changed since the last identification.");
  ImGui::TextUnformatted("Changed since the last identification:");
  ImGui::TextWrapped("%s", with_plus_minus(text).c_str());
}

// Draws the results; returns true once the dialog is to be closed.
bool draw_found(IdentifyController& controller) {
  const IdentifyController::Done& done = *controller.done();
  joints_table(done.identification);
  ImGui::TextWrapped("%s", device_text(done.identification).c_str());
  draw_drift(done.drift);
  muted("Report: " + (done.report / "report.html").string());
  if (ImGui::Button("Open the report")) open_elsewhere(done.report / "report.html");
  if (!done.no_pictures.empty()) muted("Without pictures: " + done.no_pictures);
  ImGui::Spacing();
  if (controller.simulated()) {
    muted(
        "This was a demonstration with a simulated device. Its values differ from the arm's file. "
        "Limpid does not keep the values found.");
  } else {
    if (ImGui::Button("Use the new values (Enter)") || accepted()) {
      controller.keep();
      return controller.wrong().empty();
    }
    tooltip("From now on Limpid uses the values found for this device.");
    ImGui::SameLine();
  }
  if (noted_button(controller.simulated() ? kAgain : "Keep the old values")) controller.stop();
  return false;
}

}  // namespace

std::map<std::string, ImVec2> IdentifyDialog::places() {
  std::map<std::string, ImVec2> all;
  for (const char* label : {kWithLoad, kLoad, kGoOn, kAgain}) {
    if (const auto at = noted_place(kTitle, label)) all[label] = *at;
  }
  return all;
}

void IdentifyDialog::draw_question(IdentifyController& controller, const ArmDescription& arm) {
  ImGui::TextWrapped(
      "The motors move the device: first each joint slowly, then all joints together. From this "
      "motion Limpid computes inertia, friction, weight, springs and delay. Couplings, stability "
      "margins and compensation use these values.");
  ImGui::Spacing();
  part_slider("of each joint's range", request_.plan.range, 0.05f, 0.9f,
              "How far each joint moves, around the middle of the joint's range.");
  part_slider("of the motors' limits", request_.plan.torque, 0.05f, 1,
              "Largest torque that the motors may give during the identification.");
  int down = static_cast<int>(down_);
  ImGui::SetNextItemWidth(-kLabels * ImGui::GetFontSize());
  ImGui::Combo("down, seen from the base", &down, kDownLabels.data(),
               static_cast<int>(kDownLabels.size()));
  down_ = static_cast<Down>(down);
  ImGui::Checkbox(kWithLoad, &with_load_);
  note_place(kWithLoad);
  tooltip(
      "With a known mass at the tip Limpid measures how much of the commanded torque the motors "
      "really give.");
  if (with_load_) {
    ImGui::SetNextItemWidth(-kLabels * ImGui::GetFontSize());
    constexpr auto kLeast = static_cast<float>(1e3 * kLeastLoad);
    constexpr float kMost = 300;  // [g]
    float load = load_;
    const bool changed =
        ImGui::SliderFloat(kLoad, &load, kLeast, kMost, "%.0f g", ImGuiSliderFlags_Logarithmic);
    note_number_item();
    note_place(kLoad);
    if (counts(ImGui::GetID(kLoad), changed, load >= kLeast && load <= kMost,
               fmt::format("{:g} to {:g} g", kLeast, kMost))) {
      load_ = load;
    }
  }
  ImGui::Spacing();
  const std::string why_not = controller.why_not();
  muted(!why_not.empty() ? why_not
        : controller.simulated()
            ? "No device is in use. As a demonstration Limpid moves a simulated device. Its values "
              "differ from the arm's file."
            : fmt::format("The identification takes about {:.0f} s. Clear the space around the "
                          "device, and let go of the device. Nobody may hold the device meanwhile.",
                          controller.duration(request_.plan)));
  if (!controller.wrong().empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(palette(current_theme()).broken));
    ImGui::TextWrapped("Ended: %s", controller.wrong().c_str());
    ImGui::PopStyleColor();
  }
  ImGui::BeginDisabled(!why_not.empty());
  if (ImGui::Button("Begin (Enter)") || (accepted() && why_not.empty())) {
    request_.load = with_load_ ? 1e-3 * static_cast<double>(load_) : 0;
    request_.fit.gravity = gravity_of(down_, arm.gravity);
    controller.begin(request_);
  }
  ImGui::EndDisabled();
}

void IdentifyDialog::draw(bool& open, IdentifyController& controller, Down down,
                          const ArmDescription& arm) {
  const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
  const float em = ImGui::GetFontSize();
  const float wide = controller.phase() == Phase::found ? 52 * em : 36 * em;
  if (!begin_modal(kTitle, open, {std::min(wide, 0.94f * room.x), 0})) {
    if (std::exchange(was_open_, false)) controller.leave();
    return;
  }
  if (!std::exchange(was_open_, true)) down_ = down;
  switch (controller.phase()) {
    case Phase::asking: draw_question(controller, arm); break;
    case Phase::moving: draw_motion(controller, arm); break;
    case Phase::load: draw_load(controller, request_.load); break;
    case Phase::working: ImGui::TextUnformatted("Computes the values from the motion..."); break;
    case Phase::found: open = !draw_found(controller); break;
  }
  if (!controller.moving()) {  // a motion has to be stopped first
    if (controller.phase() != Phase::working) ImGui::SameLine();
    close_button("Close (Esc)", open);
  }
  ImGui::EndPopup();
}

}  // namespace limpid
