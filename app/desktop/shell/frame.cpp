#include "app/desktop/shell/frame.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/desktop/panels/coupling_panel.h"
#include "app/desktop/panels/device_panel.h"
#include "app/desktop/panels/loading_bar.h"
#include "app/desktop/panels/notice_list.h"
#include "app/desktop/panels/parameter_rows.h"
#include "app/desktop/panels/plots_panel.h"
#include "app/desktop/panels/timing_panel.h"
#include "app/desktop/panels/transport.h"
#include "app/desktop/panels/video_bar.h"
#include "app/desktop/shell/menu.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

// A border between panels that can be dragged: changes `size` by the mouse's motion along one axis.
void splitter(const char* name, ScreenRect rect, bool vertical, double direction, double& size,
              double least, double most) {
  ImGui::SetNextWindowPos(rect.min);
  ImGui::SetNextWindowSize(rect.size());
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings);
  ImGui::InvisibleButton("grip", rect.size());
  if (ImGui::IsItemActive() || ImGui::IsItemHovered()) {
    ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
  }
  if (ImGui::IsItemActive()) {
    const ImVec2 delta = ImGui::GetIO().MouseDelta;
    size += direction * static_cast<double>((vertical ? delta.x : delta.y) / current_scale());
  }
  size = std::clamp(size, least, most);
  ImGui::End();
  ImGui::PopStyleVar(2);
}

}  // namespace

void Frame::draw() {
  const auto part = [this](auto&& work) { guard(desktop_.notices(), work); };
  Settings& settings = desktop_.settings();
  part([&] { draw_menu_bar(desktop_, window_.full_screen(), act_); });
  const Layout at = lay_out();
  part([&] { draw_view(at.view); });
  if (at.show_left) part([&] { draw_coupling(at.left); });
  if (at.show_right) part([&] { draw_side(at.right); });
  if (at.show_plots) part([&] { draw_plot_row(at.plots); });
  part([&] {
    draw_transport(desktop_.playback(), desktop_.desk(), settings.parameters.tick,
                   settings.plot_length, act_, at.transport);
  });
  draw_splitters(at);
  part([&] { dialogs_.draw_reading(); });
  part([&] { dialogs_.draw_experiments(); });
  part([&] { draw_loading(desktop_.document().loader(), at.view); });
  part([&] { draw_video_bar(desktop_.playback(), at.view); });
  // What is modal comes last: ImGui fails on windows that appear after it in its first frame.
  part([&] { dialogs_.draw_scenes(act_); });
  part([&] { dialogs_.draw_sessions(); });
  draw_notices(desktop_.notices(), at.view);
}

Layout Frame::lay_out() {
  int width = 0, height = 0;
  window_.size(width, height);
  return layout_(
      desktop_.settings(),
      {.width = static_cast<float>(width),
       .height = static_cast<float>(height),
       .scale = current_scale(),
       .menu = std::round(ImGui::GetFrameHeight()),
       .transport = std::round(ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().WindowPadding.y)});
}

void Frame::draw_view(ScreenRect rect) {
  int points_x = 0, points_y = 0, pixels_x = 0, pixels_y = 0;
  window_.size(points_x, points_y);
  window_.framebuffer_size(pixels_x, pixels_y);
  ViewScene scene{.stage = desktop_.shown(),
                  .row = desktop_.row(),
                  .quality = desktop_.quality_level(),
                  .pixel_scale = points_x > 0 ? static_cast<double>(pixels_x) / points_x : 1,
                  .pixel_height = pixels_y};
  if (const PlayedSession* session = desktop_.playback().shown()) {
    scene.recorded = true;
    scene.rerun = session->rerun_row();
  } else if (const auto ref = desktop_.document().editor().selected()) {
    scene.selected = object_of(desktop_.document().scene(), *ref);
  }
  view_.draw(scene, desktop_.camera(), desktop_.desk().controls(), desktop_.settings(), rect);
}

void Frame::draw_coupling(ScreenRect rect) {
  const RowLayout& layout = desktop_.shown().channels().layout();
  const auto at = [&](Column c) { return layout.in(desktop_.row(), c)[0]; };
  const CouplingReading now{at(Column::energy_total), at(Column::energy_ledger),
                            at(Column::governor), at(Column::damping_governor)};
  draw_coupling_panel(desktop_.settings().parameters, desktop_.analysis(), now, rect);
}

// Scene, hand, device, analysis and timing.
void Frame::draw_side(ScreenRect rect) {
  Settings& settings = desktop_.settings();
  Parameters& parameters = settings.parameters;
  Desk& desk = desktop_.desk();
  const Stage& shown = desktop_.shown();
  begin_panel("side", rect);
  if (section("Scene", true)) {
    if (const PlayedSession* session = desktop_.playback().shown()) {
      ScenePanel::draw_recorded(session->document());
    } else {
      scene_.draw(desktop_.document(), desk.stage().arm(), desk.recording(), act_,
                  [this](SceneObject object) { desktop_.add_object(std::move(object)); });
    }
  }
  if (section("Hand", true)) {
    draw_parameters(parameters, shown.arm(), {"hand.stiffness", "hand.damping"});
    ImGui::Checkbox("hold where released", &settings.hold_on_release);
    tooltip("When the mouse button is released the hand stays where it is instead of letting go.");
  }
  if (section("Device", !desktop_.devices().hub().in_use().empty())) {
    draw_device_panel(desktop_.devices(), desk);
    draw_parameters(
        parameters, shown.arm(),
        {"device.torque_limit", "observer.anti_windup", "device.damping", "device.friction",
         "device.encoder_step", "observer.velocity", "model.inertia_error", "proxy.inertia_ratio"});
  }
  if (section("Analysis", false)) {
    const auto pose = shown.channels().layout().in(desktop_.row(), Column::device_position);
    analysis_.draw(parameters, shown.arm(), pose, settings.band);
  }
  if (section("Timing", true)) draw_timing(desk.loop(), quality_text(), window_.frame_time());
  ImGui::End();
}

std::string Frame::quality_text() const {
  const std::string& wanted = desktop_.settings().picture_quality;
  if (wanted != "automatic") return wanted;
  constexpr int kLevels = 1 + Quality::kLowest;
  return fmt::format("automatic, {} of {}", kLevels - desktop_.quality_level(), kLevels);
}

void Frame::draw_plot_row(ScreenRect rect) {
  const PlotSaving saving{.folder = sessions_dir(),
                          .save_png =
                              [this](const ScreenRect& box, const std::filesystem::path& file) {
                                window_.save_picture(file, box.min.x, box.min.y, box.max.x,
                                                     box.max.y);
                              },
                          .beside =
                              [this](std::function<PlotNotice()> work) {
                                desktop_.desk().save_beside(std::move(work));
                              }};
  PlayedSession* session = desktop_.playback().shown();
  draw_plots(desktop_.shown(), session != nullptr ? &session->player() : nullptr, saving, rect);
}

void Frame::draw_splitters(const Layout& at) {
  Settings& s = desktop_.settings();
  const float grip = 3 * current_scale();
  const auto [left, top] = at.view.min;
  const auto [right, middle] = at.view.max;
  if (at.show_left) {
    splitter("left grip", {{left - grip, top}, {left + grip, middle}}, true, 1, s.left, 220, 480);
  }
  if (at.show_right) {
    splitter("right grip", {{right - grip, top}, {right + grip, middle}}, true, -1, s.right, 220,
             480);
  }
  if (at.show_plots) {
    splitter("plot grip", {{0, middle - grip}, {at.plots.max.x, middle + grip}}, false, -1, s.plots,
             120, 520);
  }
}

}  // namespace limpid
