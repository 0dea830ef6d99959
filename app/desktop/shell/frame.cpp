#include "app/desktop/shell/frame.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "app/desktop/base/passivity_break.h"
#include "app/desktop/coupling/lanes_panel.h"
#include "app/desktop/playback/recorded_panel.h"
#include "app/desktop/playback/transport.h"
#include "app/desktop/plots/plots_panel.h"
#include "app/desktop/scene/picking.h"
#include "app/desktop/view/over_view.h"
#include "app/desktop/widgets/widgets.h"
#include "app/run/motor_limits.h"
#include "app/stage/picture_signs.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

// Removes signs that show the gap between device and proxy, or which law has friction.
Settings without_signs(Settings settings) {
  settings.show_ghost = settings.show_lens = settings.show_forces = settings.show_joints = false;
  settings.overlaid = false;
  return settings;
}

}  // namespace

void Frame::draw() {
  const auto part = [this](auto&& work) { guard(desktop_.notices, work); };
  Settings& settings = desktop_.settings;
  if (desktop_.blind) return draw_blind();
  part([&] { draw_menu_bar(desktop_, files_); });
  const Layout at = lay_out();
  follow_led_panel(at);
  part([&] { draw_view(at.view); });
  if (at.show_left) part([&] { draw_coupling(at.left); });
  if (at.show_right) {
    part([&] {
      begin_panel(kSidePanel, at.right, desktop_.led_panel == LedPanel::right);
      sections_.draw(act_);
      ImGui::End();
    });
  }
  if (at.show_plots) part([&] { draw_plot_row(at.plots, at.view); });
  part([&] {
    const auto mark = draw_transport(desktop_.playback, desktop_.live, settings.parameters().tick,
                                     settings.plot_length, act_, at.transport);
    if (mark) desktop_.marking.edit(*mark);
  });
  draw_splitters(at);
  draw_fold_tabs(at);
  dialogs_.draw(false, at.view);
  part([&] { draw_loading(desktop_.document.loader(), desktop_.live.recording(), at.view); });
  part([&] { draw_video_bar(desktop_.playback, at.view); });
  part([&] {
    below_banners_ = draw_banners(desktop_.banners(), at.view, signs_box(at.view), act_);
  });
  part([&] {
    const bool free = desktop_.dialog.kind() == nullptr && !desktop_.playback.on();
    free ? your_turn_.draw(settings, at.view, view_.crowd()) : your_turn_.hide();
  });
  part([&] {
    const std::string_view open = desktop_.dialog.name();
    if (open == "sweep" || open == "ask") return;  // it would cover these
    if (story_asked_for(desktop_.playback, settings, at.view, view_.hinted())) act_("help.story");
  });
  // Modal dialogs come last: ImGui fails on windows that appear after them in their first frame.
  dialogs_.draw(true, at.view);
  notices_.draw(desktop_.notices, at.view, below_banners_, view_.crowd_with_signs());
}

// Ends the lead of the keys with a click, a dialog, or the panel's end. Passes over panels that are
// not shown.
void Frame::follow_led_panel(const Layout& at) {
  LedPanel& led = desktop_.led_panel;
  if (led == LedPanel::left && !at.show_left) led = LedPanel::right;
  if (led == LedPanel::right && !at.show_right) led = LedPanel::none;
  const bool clicked = ImGui::IsMouseClicked(0) || ImGui::IsMouseClicked(1);
  if (clicked || desktop_.dialog.kind() != nullptr) led = LedPanel::none;
}

// Draws only the picture, banners and modal dialogs: nothing that tells couplings apart.
void Frame::draw_blind() {
  desktop_.led_panel = LedPanel::none;
  const FrameSize size = size_();
  const ScreenRect view{{0, 0}, {static_cast<float>(size.width), static_cast<float>(size.height)}};
  const auto part = [this](auto&& work) { guard(desktop_.notices, work); };
  part([&] { draw_view(view); });
  part([&] { draw_banners(desktop_.banners(), view, {view.min, view.min}, act_); });
  dialogs_.draw(true, view);
}

// Returns the part of the view that banners leave free: the legend's corner, or all of the top.
ScreenRect Frame::signs_box(ScreenRect view) {
  const float em = ImGui::GetFontSize();
  if (desktop_.playback.video().busy()) return {view.min, {view.max.x, view.min.y + 7 * em}};
  if (view_scene().split()) return {view.min, {view.max.x, view.min.y + 4 * em}};
  return legend_box(view);
}

Layout Frame::lay_out() {
  const FrameSize size = size_();
  return layout_(
      desktop_.settings,
      {.width = static_cast<float>(size.width),
       .height = static_cast<float>(size.height),
       .scale = current_scale(),
       .menu = std::round(ImGui::GetFrameHeight()),
       .transport = std::round(ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().WindowPadding.y)});
}

ViewScene Frame::view_scene() {
  const FrameSize size = size_();
  ViewScene scene{
      .stage = desktop_.shown.stage(),
      .row = desktop_.shown.row(),
      .quality = desktop_.shown.quality_level(),
      .pixel_scale = size.width > 0 ? static_cast<double>(size.pixels_x) / size.width : 1,
      .pixel_height = size.pixels_y};
  if (const PlayedSession* session = desktop_.playback.shown()) {
    scene.recorded = true;
    scene.rerun = session->rerun_row();
    if (const StoryStep* step = session->step()) scene.told = step->caption;
  } else if (const auto selected = desktop_.document.editor().selected()) {
    scene.selected =
        placed_now(desktop_.document.scene(), *selected, bodies_of(scene.stage, scene.row));
  }
  const auto rows = desktop_.shown.rows();
  scene.beside.assign(rows.begin() + std::min<std::ptrdiff_t>(1, std::ssize(rows)), rows.end());
  if (!scene.beside.empty()) scene.names = desktop_.shown.stage().names();
  scene.blind = desktop_.blind;
  if (!scene.recorded && !scene.blind) {
    scene.grasp = [this](const Ray& ray) {
      const SceneEditor& editor = desktop_.document.editor();
      return body_under(ray, editor.scene(), editor.models(),
                        bodies_of(desktop_.shown.stage(), desktop_.shown.row()));
    };
  }
  if (!scene.recorded) {
    // A drag asks for many rays in a frame.
    scene.aim = [this, bodies = std::optional<std::vector<Pose>>()](const Ray& ray) mutable {
      if (!bodies) bodies = bodies_of(desktop_.shown.stage(), desktop_.shown.row());
      return aim_along(ray, desktop_.document.scene(), *bodies);
    };
    scene.drop = [this](const Vec3& point) {
      return drop_below(point, desktop_.document.scene(),
                        bodies_of(desktop_.shown.stage(), desktop_.shown.row()));
    };
  }
  scene.asked = desktop_.dialog.name() == "ask";
  if (scene.blind && scene.beside.size() == 1) scene.names = {{"left", "right"}, true};
  if (scene.blind && scene.beside.size() == 2) scene.names = {{"left", "middle", "right"}, true};
  if (your_turn_.rect()) scene.cards.push_back(*your_turn_.rect());
  scene.pad = desktop_.pads.leading();
  scene.overlaid = desktop_.settings.overlaid;
  return scene;
}

void Frame::draw_view(ScreenRect rect) {
  if (story_taken_over(desktop_.playback, rect)) desktop_.playback.take_over();
  Camera& camera = desktop_.shown.camera;
  ViewScene scene = view_scene();
  if (below_banners_.max.x >= rect.max.x) scene.words = below_banners_.max.y - rect.min.y;
  const float width = rect.width() / static_cast<float>(scene.pictures());
  constexpr double kApart = 2;  // tolerance for gaps of pictures and for rounding [px]
  const bool resized = std::abs(camera.width() - static_cast<double>(width)) > kApart ||
                       std::abs(camera.height() - static_cast<double>(rect.height())) > kApart;
  if (resized && desktop_.shown.automatic_view() && width >= 8 && rect.height() >= 8) {
    camera.resize(width, rect.height());
    desktop_.shown.reset_view();
    camera.finish();
  }
  Settings without = without_signs(desktop_.settings);
  Settings& settings = desktop_.blind ? without : desktop_.settings;
  desktop_.shown.picture = part_of(rect, 0, scene.pictures());
  const bool acts = !scene.recorded && !desktop_.blind;
  const bool taken = acts && !scene.split() && draw_handles(scene, rect);
  const ViewRequest asked =
      view_.draw(scene, camera, desktop_.live.controls(), settings, rect, taken);
  if (asked.turned) desktop_.shown.keep_view();
  if (asked.clicked && acts) select_under(*asked.clicked, scene);
  if (asked.asked && acts) {
    select_under(*asked.asked, scene);
    ImGui::OpenPopup(kObjectMenu);
  }
  draw_object_menu(desktop_);
}

std::vector<Pose> Frame::bodies_of(const Stage& stage, std::span<const double> row) {
  return stage.rows().bodies(stage.channels().layout(), row);
}

bool Frame::draw_handles(const ViewScene& scene, ScreenRect rect) {
  const Camera& camera = desktop_.shown.camera;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool on_tip =
      ViewPanel::near_tip(scene, camera, {mouse.x - rect.min.x, mouse.y - rect.min.y});
  return desktop_.transform.draw(desktop_.document, bodies_of(scene.stage, scene.row), camera, rect,
                                 on_tip);
}

void Frame::select_under(const Ray& ray, const ViewScene& scene) {
  SceneEditor& editor = desktop_.document.editor();
  editor.select(
      object_under(ray, editor.scene(), editor.models(), bodies_of(scene.stage, scene.row)));
}

bool Frame::differs() {
  bool different = false;
  guard(desktop_.notices, [&] {
    const PlayedSession* session = desktop_.playback.shown();
    const bool filled = seen_of_sweep_ != desktop_.sweep.revision();
    seen_of_sweep_ = desktop_.sweep.revision();
    different =
        filled || (session != nullptr && session->player().playing()) ||
        view_.differs(view_scene(), desktop_.shown.camera,
                      desktop_.blind ? without_signs(desktop_.settings) : desktop_.settings);
  });
  return different;
}

// Returns whether a lane chatters now, live or where the recording is played.
bool Frame::chatters(std::size_t lane) {
  PlayedSession* const played = desktop_.playback.shown();
  if (played == nullptr) {
    const auto& found = desktop_.chatter.found();
    return found && found->lane == lane;
  }
  const Stage& stage = played->stage();
  if (std::exchange(chatter_of_, &stage) != &stage) played_chatter_ = {};
  const std::vector<Parameters> settings = played->lane_settings();
  if (lane >= settings.size()) return false;
  return played_chatter_[lane].there(stage.history, played->player().index(),
                                     stage.channels().lane(lane).first,
                                     coupling_springs(stage.arm(), settings[lane]));
}

void Frame::draw_coupling(ScreenRect rect) {
  const Stage& shown = desktop_.shown.stage();
  const TraceChannels& channels = shown.channels();
  const RowLayout& layout = channels.layout();
  const auto rows = desktop_.shown.rows();
  const std::size_t lane = desktop_.tuning.edited_lane();
  const std::span<const double> row = lane < rows.size() ? rows[lane] : desktop_.shown.row();
  const auto at = [&](Column c) { return layout.in(row, c)[0]; };
  CouplingReading reading{at(Column::energy_total),
                          at(Column::energy_compensation),
                          shown.energy[lane],
                          chatters(lane),
                          {},
                          at(Column::energy_ledger),
                          at(Column::governor),
                          at(Column::damping_governor),
                          at(Column::torque_governor),
                          at(Column::unsettled),
                          layout.bodies() > 0 ? at(Column::objects_left_out) : 0,
                          layout.bodies() > 0 ? at(Column::objects_stood_still) : 0,
                          layout.bodies() > 0 ? at(Column::objects_turned_less) : 0};
  for (int j = 0; j < layout.dof(); ++j) {
    if (channels.limited(row, j, lane)) reading.limited.push_back(j);
  }
  PlayedSession* const played = desktop_.playback.shown();
  const Parameters& settings = played != nullptr ? played->settings() : desktop_.tuning.edited();
  reading.warm = warm_text(shown.arm(), settings, layout, row);
  std::vector<double> values(static_cast<std::size_t>(channels.count()));
  channels.values(row, values, lane);
  const auto value = [&](const char* key) {
    const auto channel = channels.find(key);
    return channel ? values[static_cast<std::size_t>(*channel)] : 0;
  };
  reading.error = value("coordination/error");
  reading.error_unit = channels.infos()[static_cast<std::size_t>(Channel::error)].unit;
  reading.gap = value("coordination/gap");
  reading.contact = value("contact/total_force_norm");
  reading.carries = layout.has(Column::magnet) && at(Column::magnet) > 0;
  const CouplingSituation now{.analysis = desktop_.tuning.analysis(),
                              .arm = shown.arm(),
                              .real = desktop_.live.loop().device_in_place(),
                              .broken = passivity_broken(desktop_.settings),
                              .everything = desktop_.settings.everything};
  begin_panel("coupling", rect, desktop_.led_panel == LedPanel::left);
  if (rows.size() > 1) {
    LaneSettings& lanes = desktop_.settings.lanes;
    draw_lanes(shown, rows, desktop_.playback.on() ? nullptr : &lanes.edited,
               desktop_.settings.overlaid, act_);
  }
  if (PlayedSession* session = desktop_.playback.shown()) {
    draw_played(*session, reading, now);
  } else {
    limpid::draw_coupling(desktop_.tuning.edited(), now, reading, act_);
  }
  ImGui::End();
}

// Draws recorded settings, which cannot be changed, apart from those of the next re-run.
void Frame::draw_played(PlayedSession& session, const CouplingReading& reading,
                        const CouplingSituation& now) {
  if (section("In this recording", true)) {
    draw_recorded(session, now.everything);
    const Analysis& analysis = desktop_.tuning.recorded_analysis();
    if (now.everything) {
      draw_reading(reading, session.settings(), analysis);
    } else {
      const CouplingSituation then{.analysis = analysis, .arm = now.arm, .everything = false};
      draw_simple_reading(reading, session.settings(), then);
      draw_simple_notes(reading, session.settings());
    }
  }
  if (section("Settings of the re-run (E)", true)) {
    RecordedCoupling recording{session.began_with(), {}, session.tried()};
    for (const SettingChange& change : session.player().session().changes) {
      recording.changed.emplace_back(change.key());
    }
    draw_coupling_of_rerun(desktop_.tuning.edited(), recording, desktop_.settings.parameters(),
                           now);
  }
}

// Saves a plot as the export dialog's defaults do: the picture of the SVG, dense enough for print.
void Frame::save_plot(const ScreenRect& box, const std::filesystem::path& file) {
  const Stage& stage = desktop_.shown.stage();
  const auto here = [&](const Plot& plot) { return box.contains(plot.area().min); };
  const auto plot = std::ranges::find_if(stage.plots, here);
  if (plot == stage.plots.end()) return;
  ExportOrder order;
  order.plot = static_cast<std::size_t>(plot - stage.plots.begin());
  order.file = file;
  desktop_.exporter.carry_out(order, stage);
}

// Draws the row of plots and carries out its requests; draws the selected range's figures over the
// view.
void Frame::draw_plot_row(ScreenRect rect, ScreenRect view) {
  const PlotSaving saving{
      .folder = sessions_dir(),
      .save_png = [this](const ScreenRect& box,
                         const std::filesystem::path& file) { save_plot(box, file); },
      .beside =
          [this](std::function<PlotNotice()> work) { desktop_.live.save_beside(std::move(work)); },
      .arranged = true};
  PlayedSession* session = desktop_.playback.shown();
  Player* player = session != nullptr ? &session->player() : nullptr;
  const PlotsRequest asked = draw_plots(desktop_.shown.stage(), player, saving, rect);
  figures_.draw(desktop_.shown.stage(), player, saving, view);
  if (asked.wish == PlotWish::add) desktop_.plots.add();
  if (asked.wish == PlotWish::choose) desktop_.plots.choose(asked.plot);
  if (asked.wish == PlotWish::export_as) desktop_.exporter.begin(asked.plot);
  if (asked.wish == PlotWish::remove) desktop_.plots.remove(asked.plot);
  if (!asked.dropped.empty()) desktop_.plots.show_in(asked.plot, asked.dropped);
}

void Frame::draw_fold_tabs(const Layout& at) {
  Settings& s = desktop_.settings;
  const float wide = 12 * current_scale(), high = 44 * current_scale();
  const auto [left, top] = at.view.min;
  const auto [right, bottom] = at.view.max;
  const float x = std::round((left + right - high) / 2), y = std::round((top + bottom - high) / 2);
  const float grip = 3 * current_scale();
  fold_tab("left tab", {{left + grip, y}, {left + grip + wide, y + high}},
           at.show_left ? ImGuiDir_Left : ImGuiDir_Right,
           at.show_left ? "Hides the coupling panel (F2)" : "Shows the coupling panel (F2)",
           s.show_left);
  fold_tab("right tab", {{right - grip - wide, y}, {right - grip, y + high}},
           at.show_right ? ImGuiDir_Right : ImGuiDir_Left,
           at.show_right ? "Hides the panel of scene and device (F3)"
                         : "Shows the panel of scene and device (F3)",
           s.show_right);
  fold_tab("plots tab", {{x, bottom - grip - wide}, {x + high, bottom - grip}},
           at.show_plots ? ImGuiDir_Down : ImGuiDir_Up,
           at.show_plots ? "Hides the plots (F4)" : "Shows the plots (F4)", s.show_plots);
}

void Frame::draw_splitters(const Layout& at) {
  Settings& s = desktop_.settings;
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
