#include "app/desktop/shell/run_desktop.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "app/base/input_end.h"
#include "app/base/interrupt.h"
#include "app/desktop/base/kept_settings.h"
#include "app/desktop/device/pads.h"
#include "app/desktop/scene/unsaved.h"
#include "app/desktop/shell/command_keys.h"
#include "app/desktop/shell/commands.h"
#include "app/desktop/shell/frame.h"
#include "app/desktop/shell/state.h"
#include "app/desktop/shell/window.h"
#include "app/desktop/shell/window_remote.h"
#include "app/live/rtkit.h"
#include "core/realtime/realtime.h"

namespace limpid {
namespace {

constexpr double kBetweenStates = 0.09;  // least time between two lines [s]; slow frames: more
void say(const std::string& line) { std::fputs(fmt::format("limpid: {}\n", line).c_str(), stderr); }

// Keeps changes that the user could not be asked about for the next start.
void keep_changes(const SceneDocument& document, const ArmDescription& arm,
                  const std::string& scene_file) {
  const std::string name = std::filesystem::path(scene_file).stem().string();
  for (const std::filesystem::path& folder :
       {scenes_dir(), std::filesystem::temp_directory_path() / "limpid"}) {
    try {
      const auto file = keep_unsaved(document, arm, name, folder);
      say("unsaved changes were saved in " + file.string());
      return;
    } catch (const std::exception& e) {
      say(fmt::format("unsaved changes: {}", e.what()));
    }
  }
}

Settings with(Settings settings, const DesktopOptions& options) {
  if (options.parameters) settings.parameters() = options.parameters(settings.parameters());
  return settings;
}

class Application {
 public:
  // Starts the haptic thread first: its scheduling decides how the window behaves, and OpenGL's own
  // threads inherit that.
  Application(const DesktopOptions& options, const Settings& settings)
      : options_(options),
        kept_(settings),
        desktop_(with(settings, options),
                 [this](pid_t thread, int priority) { return ask_rtkit(thread, priority, &why_); }),
        window_(prepare_window()),
        frame_(
            desktop_,
            [this] {
              FrameSize size;
              window_.size(size.width, size.height);
              window_.framebuffer_size(size.pixels_x, size.pixels_y);
              return size;
            },
            [this](std::string_view id) { run_or_say(id, desktop_); }) {
    desktop_.key_labels = &window_.key_labels();
  }
  ~Application() {  // pictures go before the window they are drawn in
    remote_.reset();
    frame_.drop_pictures();
    desktop_.drop_pictures();
  }
  Application(const Application&) = delete;
  Application& operator=(const Application&) = delete;

  void open();
  void run(const std::string& complaint);  // on the settings
  void note_size();                        // notes the window's size for the next start
  void keep();                             // keeps settings for the next start
  void finish();                           // stops the motors and completes the recording
  // Ends the program. with_scene: keeps the scene's changes, which nobody decided on.
  void leave_without_display(bool with_scene);

 private:
  Window::Options prepare_window();
  void turn();
  void carry_out(const WindowRequests& asked);
  bool asked_to_close();  // returns whether it may end at once
  void keep_scene();      // keeps changes that nobody was asked about
  void say_what_was_saved();
  Settings settings_to_keep() const;

  const DesktopOptions& options_;
  KeptSettings kept_;
  std::string why_;
  Desktop desktop_;
  Window window_;
  Frame frame_;
  double last_ = 0;
  std::optional<WindowRemote> remote_;
  double printed_ = 0;  // when the state was printed last [s]
  long frames_ = 0;
  bool leaving_ = false;
};

Window::Options Application::prepare_window() {
  if (!desktop_.live.loop().status().realtime.realtime()) yield_to_haptics();
  const Settings& settings = desktop_.settings;
  return {.width = settings.width,
          .height = settings.height,
          .ui_scale = options_.ui_scale > 0 ? options_.ui_scale : settings.ui_scale,
          .text_size = settings.text_size,
          .theme = settings.theme};
}

void Application::open() {
  desktop_.shown.automatic_quality = AutoQuality(Quality::automatic_level(window_.renderer()));
  desktop_.world.open_last(options_.device, options_.tip, options_.scene,
                           options_.parameters != nullptr);
  // A double click on a file asks for the file, not for a device.
  if (!options_.session.empty() || !options_.files.empty()) {
    desktop_.devices.wait_for_choice(
        "This window was started with a file. Therefore it does not connect to a device by "
        "itself.");
  }
  if (!options_.in_use.empty()) desktop_.devices.use(options_.in_use);
  if (!options_.listen.empty()) remote_.emplace(options_.listen, desktop_);
}

void Application::run(const std::string& complaint) {
  Notices& notices = desktop_.notices;
  for (const std::string& each :
       {complaint, desktop_.plots.layouts.complaint(), desktop_.tuning.presets.complaint(),
        desktop_.devices.hub().complaint()}) {
    if (!each.empty()) notices.say(each, true);
  }
  desktop_.playback.recover_leftovers(sessions_dir());
  desktop_.kept.offer(take_unsaved(scenes_dir()));
  if (!options_.session.empty()) desktop_.playback.open(options_.session);
  desktop_.world.open_files(options_.files);
  last_ = glfwGetTime();
  while (!leaving_) {
    if (window_.wait()) {
      turn();
    } else if (asked_to_close()) {
      break;
    }
  }
}

// Asks about a running recording and unsaved changes, unless an interrupt came from outside.
bool Application::asked_to_close() {
  if (interrupted) {
    desktop_.cut_force();  // before any file is written
    keep_scene();
    return true;
  }
  window_.keep_open();
  const bool may_end = std::exchange(desktop_.recording_may_end, false);
  if (desktop_.live.recording() && !may_end) {
    desktop_.dialog.open("quit");
  } else {
    desktop_.document.leave([this] { leaving_ = true; });
  }
  return false;
}

void Application::keep_scene() {
  const Document& document = desktop_.document;
  if (!document.editor().dirty()) return;
  keep_changes(document.editor().document(), desktop_.live.stage().arm(), document.file());
}

// Stops the motors first, also of a device that a check or an identification moves, then completes
// the recording.
void Application::finish() {
  try {
    desktop_.cut_force();
    desktop_.live.loop().close();
    desktop_.live.complete_recording();
  } catch (const std::exception& e) {
    say(e.what());
  }
}

// Ends without asking the display for anything. Settings come last.
void Application::leave_without_display(bool with_scene) {
  say("the connection to the display was lost");
  finish();
  if (with_scene) keep_scene();
  keep();
  std::_Exit(1);
}

// Does the desktop's work of a turn; draws a frame only if there is something new to see.
void Application::turn() {
  Notices& notices = desktop_.notices;
  if (options_.until_eof && input_has_ended()) interrupted = true;
  if (interrupted) window_.close();
  const double now = glfwGetTime();
  bool asked_for = false;
  guard(notices, [&] { asked_for = remote_ && remote_->turn(); });
  bool drawing = window_.due() || asked_for;
  window_.set_look(desktop_.settings.theme, desktop_.settings.text_size);
  if (drawing) {
    window_.begin_frame(desktop_.focus());
    desktop_.document.hold(ImGui::IsMouseDown(ImGuiMouseButton_Left) ||
                           desktop_.transform.follows());
    guard(notices, [&] { handle_keys(window_.keys(), desktop_); });
    guard(notices, [&] {
      if (!desktop_.blind) desktop_.world.open_files(window_.dropped());
    });
  }
  guard(notices, [&] { desktop_.follow_pads(plugged_pads(), window_.focused(), now - last_); });
  guard(notices, [&] { desktop_.update(now - last_); });
  if (kept_.due(now)) {
    if (const std::string failure = kept_.follow(settings_to_keep()); !failure.empty()) {
      notices.say("The settings were not saved: " + failure, true);
    }
  }
  last_ = now;
  const bool moved = frame_.differs();
  if (moved && !drawing) window_.begin_frame(desktop_.focus());
  drawing |= moved;
  if (drawing) frame_.draw();
  carry_out(std::exchange(desktop_.asked, {}));
  if (drawing) {
    window_.end_frame();
    say_what_was_saved();
    // Only a new picture shows how fast this computer draws.
    if (moved) desktop_.shown.automatic_quality.frame(window_.frame_time());
  }
  frames_ += drawing ? 1 : 0;
  if (options_.print_state && now - printed_ >= kBetweenStates) {
    printed_ = now;
    int width = 0, height = 0;
    window_.size(width, height);
    print_state(desktop_, {width, height, frames_, window_.input_waits(), window_.input_taken()});
  }
}

void Application::carry_out(const WindowRequests& asked) {
  if (asked.toggle_full_screen) window_.toggle_full_screen();
  desktop_.full_screen = window_.full_screen();
  desktop_.frame_time = window_.frame_time();
  if (!asked.picture.empty()) window_.save_picture(asked.picture);
  if (asked.close) window_.close();
}

void Application::say_what_was_saved() {
  if (remote_) remote_->saved(window_.saved());
  for (const SavedPicture& picture : window_.saved()) {
    if (picture.error.empty()) {
      desktop_.exporter.wrote(picture.file);  // a banner says so
    } else {
      desktop_.notices.say(
          picture.error + ". Make sure that the folder exists and that you may write to it.", true);
    }
  }
}

void Application::note_size() {
  Settings& settings = desktop_.settings;
  if (!window_.full_screen()) window_.asked_size(settings.width, settings.height);
}

void Application::keep() {
  if (const SetAside* waiting = desktop_.document.unsaved_set_aside()) {
    keep_changes(waiting->world->document, waiting->arm, waiting->file);
  }
  if (const std::string error = kept_.keep(settings_to_keep()); !error.empty()) {
    say("the settings were not saved: " + error);
  }
}

// Returns the settings to keep. Of a window that a program started only the looks are kept: all
// else is the program's.
Settings Application::settings_to_keep() const {
  Settings kept = desktop_.lead.settings_to_keep();
  if (!options_.until_eof) return kept;
  const Settings& before = kept_.kept();
  kept.lanes = before.lanes;
  kept.scene = before.scene;
  kept.device = before.device;
  kept.device_tip = before.device_tip;
  kept.recent = before.recent;
  return kept;
}

}  // namespace

void run_desktop(const DesktopOptions& options) {
  give_back_what_is_freed();
  std::string complaint;
  const Settings settings = load_settings(complaint);
  Application application(options, settings);
  catch_interrupts();
  when_display_is_lost([&application] { application.leave_without_display(true); });
  application.open();
  application.run(complaint);
  when_display_is_lost([&application] { application.leave_without_display(false); });
  application.note_size();   // asks the display for the last time
  when_display_is_lost({});  // the lines below do the same
  application.finish();
  application.keep();
}

}  // namespace limpid
