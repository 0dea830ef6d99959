#include "app/desktop/shell/frame.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/desktop/base/passivity_break.h"
#include "app/desktop/panels/banners.h"
#include "app/desktop/panels/device_panel.h"
#include "app/desktop/panels/loading_bar.h"
#include "app/desktop/panels/notice_list.h"
#include "app/desktop/panels/parameter_rows.h"
#include "app/desktop/panels/recorded_panel.h"
#include "app/desktop/panels/story_bar.h"
#include "app/desktop/panels/timing_panel.h"
#include "app/desktop/panels/transport.h"
#include "app/desktop/panels/twin_panel.h"
#include "app/desktop/panels/video_bar.h"
#include "app/desktop/shell/menu.h"
#include "app/desktop/sweep/sweep_desk.h"
#include "app/desktop/widgets/panel_edges.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {

void Frame::draw() {
  const auto part = [this](auto&& work) { guard(desktop_.notices(), work); };
  Settings& settings = desktop_.settings();
  part([&] { draw_menu_bar(desktop_, recent_, window_.full_screen(), act_); });
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
  draw_fold_tabs(at);
  part([&] { dialogs_.draw_reading(); });
  part([&] { dialogs_.draw_experiments(); });
  part([&] { dialogs_.draw_sweep(); });
  part([&] { dialogs_.draw_plot_chooser(at.view); });
  part([&] { draw_loading(desktop_.document().loader(), at.view); });
  part([&] { draw_video_bar(desktop_.playback(), at.view); });
  part([&] {
    below_banners_ = draw_banners(desktop_.banners(), at.view, signs_box(at.view), act_);
  });
  part([&] {
    if (desktop_.dialog() == Dialog::sweep) return;  // which it would cover
    const bool hinted = desktop_.twin_row().empty();
    if (story_asked_for(desktop_.playback(), settings, at.view, hinted)) desktop_.play_story();
  });
  // What is modal comes last: ImGui fails on windows that appear after it in its first frame.
  part([&] { dialogs_.draw_scenes(act_); });
  part([&] { dialogs_.draw_sessions(); });
  part([&] { dialogs_.draw_named(); });
  part([&] { dialogs_.draw_identify(); });
  draw_notices(desktop_.notices(), at.view, below_banners_);
}

// What notices leave free: the legend's corner, or all that is at the top of the view.
ScreenRect Frame::signs_box(ScreenRect view) {
  const float em = ImGui::GetFontSize();
  if (desktop_.playback().video().busy()) return {view.min, {view.max.x, view.min.y + 7 * em}};
  if (view_scene().split()) return {view.min, {view.max.x, view.min.y + 4 * em}};
  return legend_box(view);
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

ViewScene Frame::view_scene() {
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
    scene.twin = session->twin_row();
    if (const StoryStep* step = session->step()) scene.told = step->caption;
  } else if (const Object* selected = desktop_.document().editor().selected_object()) {
    scene.selected = *selected;
  }
  if (!scene.recorded) scene.twin = desktop_.desk().twin_row();
  if (!scene.twin.empty()) scene.names = desktop_.shown().names();
  scene.pad = desktop_.leading_pad();
  scene.overlaid = desktop_.settings().twin_overlaid;
  return scene;
}

void Frame::draw_view(ScreenRect rect) {
  if (story_taken_over(desktop_.playback(), rect)) desktop_.playback().take_over();
  Camera& camera = desktop_.camera();
  const ViewScene scene = view_scene();
  const float width = scene.split() ? rect.width() / 2 : rect.width();
  constexpr double kApart = 2;  // between the halves of a twin, and rounding [px]
  const bool resized = std::abs(camera.width() - static_cast<double>(width)) > kApart ||
                       std::abs(camera.height() - static_cast<double>(rect.height())) > kApart;
  if (resized && desktop_.automatic_view() && width >= 8 && rect.height() >= 8) {
    camera.resize(width, rect.height());
    desktop_.reset_view();
    camera.finish();
  }
  if (view_.draw(scene, camera, desktop_.desk().controls(), desktop_.settings(), rect)) {
    desktop_.keep_view();
  }
}

bool Frame::differs() {
  bool different = false;
  guard(desktop_.notices(), [&] {
    const PlayedSession* session = desktop_.playback().shown();
    const bool filled = seen_of_sweep_ != desktop_.sweep().revision();
    seen_of_sweep_ = desktop_.sweep().revision();
    different = filled || (session != nullptr && session->player().playing()) ||
                view_.differs(view_scene(), desktop_.camera(), desktop_.settings());
  });
  return different;
}

void Frame::draw_coupling(ScreenRect rect) {
  const Stage& shown = desktop_.shown();
  const TraceChannels& channels = shown.channels();
  const RowLayout& layout = channels.layout();
  const std::span<const double> twin = desktop_.twin_row();
  const bool of_twin = desktop_.edits_twin() && !twin.empty();
  const std::span<const double> row = of_twin ? twin : desktop_.row();
  const auto at = [&](Column c) { return layout.in(row, c)[0]; };
  CouplingReading reading{shown.energy,
                          {},
                          at(Column::energy_ledger),
                          at(Column::governor),
                          at(Column::damping_governor),
                          at(Column::torque_governor),
                          at(Column::unsettled)};
  for (int j = 0; j < layout.dof(); ++j) {
    if (channels.limited(row, j)) reading.limited.push_back(j);
  }
  const CouplingSituation now{.analysis = desktop_.analysis(),
                              .arm = shown.arm(),
                              .real = desktop_.desk().loop().device_in_place(),
                              .broken = passivity_broken(desktop_.settings())};
  begin_panel("coupling", rect);
  if (!twin.empty()) {
    TwinSettings& settings = desktop_.settings().twin;
    draw_twin(shown, desktop_.row(), twin, desktop_.playback().on() ? nullptr : &settings.edited,
              desktop_.settings().twin_overlaid);
  }
  if (PlayedSession* session = desktop_.playback().shown()) {
    draw_played(*session, reading, now);
  } else {
    limpid::draw_coupling(desktop_.edited(), now, reading, act_);
  }
  ImGui::End();
}

// Two things apart: what was recorded, which nobody moves any more, and what a re-run will have.
void Frame::draw_played(PlayedSession& session, const CouplingReading& reading,
                        const CouplingSituation& now) {
  if (section("In this recording", true)) {
    draw_recorded(session);
    draw_reading(reading, session.settings(), desktop_.recorded_analysis());
  }
  if (section("For the re-run (E)", true)) draw_coupling_of_rerun(desktop_.edited(), now);
}

void Frame::say_for_rerun() const {
  if (!desktop_.playback().on()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(current_palette().muted));
  ImGui::TextWrapped("For the re-run; what was recorded is on the left.");
  ImGui::PopStyleColor();
}

// Scene, hand, device, analysis and timing.
void Frame::draw_side(ScreenRect rect) {
  Settings& settings = desktop_.settings();
  Parameters& parameters = settings.parameters;
  Desk& desk = desktop_.desk();
  const Stage& shown = desktop_.shown();
  begin_panel(kSidePanel, rect);
  if (section("Scene", true)) {
    if (const PlayedSession* session = desktop_.playback().shown()) {
      ScenePanel::draw_recorded(session->document());
    } else {
      scene_.draw(desktop_.document(), desk.stage().arm(), desk.recording(), act_,
                  [this](Object object) { desktop_.add_object(std::move(object)); });
    }
  }
  if (section("Hand", true)) {
    say_for_rerun();
    draw_parameters(parameters, shown.arm(), {"hand.stiffness", "hand.damping", "hand.mass"});
    ImGui::Checkbox("hold where released", &settings.hold_on_release);
    tooltip("When the mouse button is released the hand stays where it is instead of letting go.");
  }
  if (section("Device", !desktop_.devices().hub().in_use().empty())) {
    if (draw_device_panel(desktop_.devices(), desk, {desktop_.pads(), settings.gamepad},
                          parameters)) {
      desktop_.open_dialog(Dialog::identify);
    }
    say_for_rerun();
    if (!desk.loop().device_in_place()) {
      draw_parameters(
          parameters, shown.arm(),
          {"device.gravity", "device.springs", "model.gravity", "model.springs", "model.friction"});
    }
    draw_parameters(
        parameters, shown.arm(),
        {"device.torque_limit", "observer.anti_windup", "device.damping", "device.friction",
         "device.encoder_step", "device.delay", "model.delay", "predictor.preset",
         "observer.velocity", "model.inertia_error", "proxy.inertia_ratio"});
  }
  if (section("Analysis", false)) {
    const auto pose = shown.channels().layout().in(desktop_.row(), Column::device_position);
    PlayedSession* session = desktop_.playback().shown();
    const Scene& scene = session ? session->document().scene : desktop_.document().scene();
    analysis_.draw(session ? session->settings() : desktop_.edited(), shown.arm(), scene, pose,
                   settings.band);
  }
  if (section("Timing", true)) {
    draw_timing(desk.loop(), quality_text(), window_.frame_time());
    if (desk.loop().device_in_place()) {
      device_timing_.draw(desk.loop().device_pace(), desk.stage().arm(), parameters,
                          desktop_.document().scene(),
                          desk.loop().layout().in(desk.row(), Column::device_position));
    }
  }
  ImGui::End();
}

std::string Frame::quality_text() const {
  const std::string& wanted = desktop_.settings().picture_quality;
  if (wanted != "automatic") return wanted;
  const int level = desktop_.quality_level();
  if (level == 0) return "automatic: best";
  if (level == Quality::kLowest) return "automatic: lowest";
  return fmt::format("automatic: {} below best", level);
}

void Frame::draw_fold_tabs(const Layout& at) {
  Settings& s = desktop_.settings();
  const float wide = 12 * current_scale(), high = 44 * current_scale();
  const auto [left, top] = at.view.min;
  const auto [right, bottom] = at.view.max;
  const float x = std::round((left + right - high) / 2), y = std::round((top + bottom - high) / 2);
  const float grip = 3 * current_scale();
  fold_tab("left tab", {{left + grip, y}, {left + grip + wide, y + high}},
           at.show_left ? ImGuiDir_Left : ImGuiDir_Right,
           at.show_left ? "Folds the coupling panel (F2)" : "The coupling panel (F2)", s.show_left);
  fold_tab("right tab", {{right - grip - wide, y}, {right - grip, y + high}},
           at.show_right ? ImGuiDir_Right : ImGuiDir_Left,
           at.show_right ? "Folds the scene and device panel (F3)"
                         : "Scene, hand, device and timing (F3)",
           s.show_right);
  fold_tab("plots tab", {{x, bottom - grip - wide}, {x + high, bottom - grip}},
           at.show_plots ? ImGuiDir_Down : ImGuiDir_Up,
           at.show_plots ? "Folds the plots (F4)" : "The plots (F4)", s.show_plots);
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
