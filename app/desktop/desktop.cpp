#include "app/desktop/desktop.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/interrupt.h"
#include "app/desktop/experiments_panel.h"
#include "app/desktop/guard.h"
#include "app/desktop/keys.h"
#include "app/desktop/layout.h"
#include "app/desktop/panels.h"
#include "app/desktop/scene_dialogs.h"
#include "app/desktop/unsaved.h"
#include "app/live/rtkit.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

// A border between panels that can be dragged: changes `size` by the mouse's motion along one axis.
void splitter(const char* name, const ScreenRect& rect, bool vertical, double direction,
              double& size, double least, double most) {
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

// The parts of the window that remember something themselves.
struct Panels {
  WindowLayout layout;
  ViewPanel view;
  SidePanel side;
  SceneDialogs scene;
  SessionDialog session;
  ExperimentsPanel experiments;
};

// What throws becomes a notice, but not the same one in every frame.
template <class Work>
void guard(Workbench& bench, Work&& work) {
  guarded(
      [&bench](const char* what) {
        const auto same = [what](const Notice& notice) { return notice.text == what; };
        if (std::ranges::none_of(bench.notices, same)) bench.say(what, true);
      },
      std::forward<Work>(work));
}

void draw(Workbench& bench, Window& window, Panels& panels) {
  const auto part = [&bench](auto&& work) { guard(bench, work); };
  part([&] { draw_menu_bar(bench, window); });
  int width = 0, height = 0;
  window.size(width, height);
  Settings& s = bench.settings;
  const float scale = current_scale();
  const Layout at = panels.layout(
      s,
      {.width = static_cast<float>(width),
       .height = static_cast<float>(height),
       .scale = scale,
       .menu = std::round(ImGui::GetFrameHeight()),
       .transport = std::round(ImGui::GetFrameHeight() + 2 * ImGui::GetStyle().WindowPadding.y)});
  part([&] { panels.view.draw(bench, window, at.view); });
  if (at.show_left) part([&] { draw_coupling_panel(bench, at.left); });
  if (at.show_right) part([&] { panels.side.draw(bench, at.right, window.frame_time()); });
  if (at.show_plots) part([&] { draw_plots(bench, window, at.plots); });
  part([&] { draw_transport(bench, at.transport); });

  const float grip = 3 * scale;
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
  part([&] { draw_dialogs(bench); });
  part([&] { panels.experiments.draw(bench); });
  // What is modal comes last: ImGui fails on windows that appear after it in its first frame.
  part([&] { panels.scene.draw(bench, at.view); });
  part([&] { panels.session.draw(bench); });
  draw_notices(bench, at.view);
}

// For scripts that drive the window.
void print_state(Workbench& bench, const Window& window) {
  const Focus focus = focus_of(bench);
  nlohmann::json notices = nlohmann::json::array();
  for (const Notice& notice : bench.notices) notices.push_back(notice.text);
  int width = 0, height = 0;
  window.size(width, height);
  const std::span<const double> row = bench.row();
  const RowLayout& layout = bench.shown().channels().layout();
  const LoopStatus status = bench.live.status();
  std::vector<double> values(static_cast<std::size_t>(bench.shown().channels().count()));
  bench.shown().channels().values(row, values);
  const auto& selected = bench.editor.selected();
  const auto channel = [&](Channel c) { return values[static_cast<std::size_t>(c)]; };
  fmt::print(
      "{{\"time\": {:.3f}, \"kind\": {}, \"eta\": {}, \"error\": {:.6f}, \"contact\": {:.5f}, "
      "\"energy_total\": {:.6g}, \"grip\": {:.2f}, \"force\": {}, \"recording\": {}, "
      "\"playing\": {}, \"rerun\": {}, \"rate\": {:.2f}, \"ticks\": {}, \"late\": {}, \"missed\": "
      "{}, "
      "\"slipped\": {}, \"dropped\": {}, \"objects\": {}, \"selected\": {}, \"loading\": {}, "
      "\"dirty\": {}, \"scene\": {}, \"asking\": {}, \"quality\": {}, \"alpha\": {}, \"dialog\": "
      "{}, "
      "\"typing\": {}, \"notices\": {}, \"size\": [{}, {}]}}\n",
      layout.in(row, Column::time)[0], channel(Channel::kind), bench.parameters.eta,
      channel(Channel::error), channel(Channel::contact), channel(Channel::energy_total),
      layout.in(row, Column::hand_grip)[0], bench.force_armed(), bench.live.recording(),
      bench.playing_back(), bench.playing_back() && !bench.playback->rerun.empty(), status.rate,
      status.ticks, status.late, status.missed, status.slipped, bench.live.trace_dropped(),
      objects_of(bench.editor.scene()).size(),
      selected ? nlohmann::json(name_of(bench.editor.scene(), *selected)).dump() : "null",
      bench.loader.busy(), bench.editor.dirty(), nlohmann::json(bench.scene_file).dump(),
      focus.question || modal(focus.dialog), bench.quality_level(), bench.parameters.alpha,
      nlohmann::json(focus.question ? "question" : name(focus.dialog)).dump(), focus.text,
      notices.dump(), width, height);
  std::fflush(stdout);
}

// The scene of last time may be gone by now; one given by hand has to be there.
void open_world(Workbench& bench, const DesktopOptions& options) {
  const std::string& device = options.device.empty() ? bench.settings.device : options.device;
  if (!options.scene.empty()) return bench.open_world(device, options.scene);
  try {
    bench.open_world(device, bench.settings.scene);
  } catch (const std::exception& e) {
    if (bench.settings.scene.empty()) throw;
    bench.open_world(device, "");
    bench.say(e.what(), true);
  }
}

// Changes that the user could not be asked about are kept for the next start.
void keep_changes(const Scene& scene, const ArmDescription& arm, const std::string& scene_file) {
  const std::string name = std::filesystem::path(scene_file).stem().string();
  for (const std::filesystem::path& folder :
       {scenes_dir(), std::filesystem::temp_directory_path() / "limpid"}) {
    try {
      const auto file = keep_unsaved(scene, arm, name, folder);
      fmt::print(stderr, "limpid: unsaved changes are in {}\n", file.string());
      return;
    } catch (const std::exception& e) {
      fmt::print(stderr, "limpid: unsaved changes: {}\n", e.what());
    }
  }
}

void tell_of_kept_changes(Workbench& bench) {
  for (const std::filesystem::path& file : take_unsaved(scenes_dir())) {
    bench.say(
        fmt::format("Limpid was ended while a scene had unsaved changes. They are in {}: open "
                    "it from the gallery (Ctrl+G).",
                    file.filename().string()));
  }
}

void say_what_was_saved(Workbench& bench, const Window& window) {
  for (const SavedPicture& picture : window.saved()) {
    if (picture.error.empty()) {
      bench.say("Saved " + picture.file.string());
    } else {
      bench.say(picture.error + ". See to it that the folder is there and can be written to.",
                true);
    }
  }
}

}  // namespace

void run_desktop(const DesktopOptions& options) {
  std::string complaint;
  Settings settings = load_settings(complaint);
  if (options.parameters) settings.parameters = *options.parameters;
  // The haptic thread comes first: what its scheduling allows decides how the window behaves, and
  // OpenGL's own threads inherit that.
  std::string why;
  Workbench bench(std::move(settings),
                  [&why](pid_t thread, int priority) { return ask_rtkit(thread, priority, &why); });
  if (!bench.live.status().realtime.realtime()) yield_to_haptics();
  Window window({.width = bench.settings.width,
                 .height = bench.settings.height,
                 .ui_scale = options.ui_scale > 0 ? options.ui_scale : bench.settings.ui_scale,
                 .theme = bench.settings.theme});
  // Pictures go before the window they are drawn in.
  const std::unique_ptr<Workbench, void (*)(Workbench*)> pictures(
      &bench, [](Workbench* b) { b->drop_pictures(); });
  catch_interrupts();
  bench.automatic_quality = AutoQuality(Quality::automatic_level(window.renderer()));
  open_world(bench, options);
  if (!complaint.empty()) bench.say(complaint, true);
  bench.recover_leftovers();
  tell_of_kept_changes(bench);
  if (!options.session.empty()) bench.open_session(options.session);

  Panels panels;
  double last = glfwGetTime();
  int frame = 0;
  bool leaving = false;
  while (!leaving) {
    if (!window.begin_frame(focus_of(bench))) {
      // Unsaved changes are asked about, unless somebody interrupts from outside.
      if (interrupted) {
        if (bench.editor.dirty()) {
          keep_changes(bench.editor.scene(), bench.stage->arm(), bench.scene_file);
        }
        break;
      }
      bench.leave_scene([&leaving] { leaving = true; });
      window.keep_open();
      continue;
    }
    if (interrupted) window.close();
    const double now = glfwGetTime();
    bench.history.hold(ImGui::IsMouseDown(ImGuiMouseButton_Left));
    guard(bench, [&] { handle_keys(bench, window); });
    guard(bench, [&] { bench.open_dropped(window.dropped()); });
    guard(bench, [&] { bench.update(now - last); });
    last = now;
    draw(bench, window, panels);
    window.end_frame();
    say_what_was_saved(bench, window);
    bench.automatic_quality.frame(window.frame_time());
    if (options.print_state && ++frame % 6 == 0) print_state(bench, window);
  }
  if (const SetAside* waiting = bench.unsaved_set_aside()) {
    keep_changes(waiting->world->scene, waiting->arm, waiting->file);
  }
  panels.scene.drop_pictures();
  if (!window.full_screen()) window.asked_size(bench.settings.width, bench.settings.height);
  if (const std::string error = save_settings(bench.settings); !error.empty()) {
    fmt::print(stderr, "limpid: settings not saved: {}\n", error);
  }
}

}  // namespace limpid
