#include "app/open_window.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "app/cli/complete.h"
#include "app/cli/options.h"
#include "app/cli/video_options.h"
#include "app/desktop/shell/run_desktop.h"
#include "app/remote/line_server.h"
#include "app/run/fitted_gains.h"
#include "app/sweep/sweep_table.h"
#include "devices/files/toml_reader.h"

namespace limpid {
namespace {

struct WindowOptions {
  InputOptions input;
  DesktopOptions desktop;
  std::string session;
  std::vector<std::string> files;     // to open
  std::vector<std::string> commands;  // available commands
  std::string listen;                 // name of a socket; empty: none
  VideoOptions video;
};

void add(CLI::App& command, WindowOptions& options) {
  options.input.add_world(command);
  options.input.add_parameters(command);
  command
      .add_option("--ui-scale", options.desktop.ui_scale,
                  "size of text and panels; default: the screen's")
      ->type_name("0.5..4")
      ->check(CLI::Range(0.5, 4.0).description(""));
  command
      .add_option_function<std::string>(
          "--listen",
          [&options](const std::string& name) { options.listen = name.empty() ? "control" : name; },
          "let programs of this user control the window, through the socket "
          "$XDG_RUNTIME_DIR/limpid/NAME.control; default: control. See `limpid serve`")
      ->type_name("[NAME]")
      ->expected(0, 1);
  command.add_flag("--until-eof", options.desktop.until_eof,
                   "with --listen: end when standard input ends (it ends with the calling "
                   "program), and store no settings");
  command.add_flag("--print-state", options.desktop.print_state,
                   "print the state as one line of JSON, ten times per second");
}

// Merges the options before and behind the command; the latter win.
WindowOptions both(const WindowOptions& before, WindowOptions behind) {
  behind.input = both(before.input, behind.input);
  if (behind.desktop.ui_scale == DesktopOptions{}.ui_scale) {
    behind.desktop.ui_scale = before.desktop.ui_scale;
  }
  if (behind.listen.empty()) behind.listen = before.listen;
  behind.desktop.print_state |= before.desktop.print_state;
  behind.desktop.until_eof |= before.desktop.until_eof;
  return behind;
}

// Checks the input before a window opens and reads it again. Leaves out models, which may be large.
// Returns null if the window keeps its own parameters.
std::function<Parameters(const Parameters&)> checked_parameters(const InputOptions& input) {
  ArmDescription arm;
  SceneDocument document;
  read_world(input, arm, document);
  if (!input.set_parameters()) return nullptr;
  make_parameters(input, arm);
  return [input, arm](const Parameters& last) {
    // A file sets all parameters; single settings change the last ones.
    if (!input.configs.empty()) return make_parameters(input, arm);
    Parameters base = last;
    refit(base, nullptr, &arm);
    return make_parameters(input, base);
  };
}

std::filesystem::path socket_called(const std::string& name) {
  try {
    return control_path(name);
  } catch (const ListenError& e) {
    throw UsageError(e.what());
  }
}

int open_window(const WindowOptions& options) {
  DesktopOptions desktop = options.desktop;
  const InputOptions& input = options.input;
  desktop.parameters = checked_parameters(input);
  if (!options.listen.empty()) desktop.listen = socket_called(options.listen);
  if (desktop.until_eof && desktop.listen.empty()) throw UsageError("--until-eof: needs --listen");
  desktop.in_use = device_named(input.device);
  if (desktop.in_use.empty()) desktop.device = input.device;
  desktop.tip = input.tip;
  desktop.scene = input.scene;
  for (const std::string& file : options.files) {
    if (!std::filesystem::exists(file)) {
      const auto meant = nearest(file, options.commands);
      throw UsageError(
          fmt::format("\"{}\": neither a command nor a file that can be opened; {}`limpid --help` "
                      "lists the commands",
                      file, meant ? fmt::format("did you mean {}? ", *meant) : ""));
    }
    desktop.files.emplace_back(file);
  }
  if (const auto table = sweep_table_at(options.session)) {
    desktop.files.push_back(*table);
  } else if (!options.session.empty()) {
    if (read_session(options.session).size() == 0) {
      throw FileError(options.session + ": contains no rows");
    }
    desktop.session = options.session;
  }
  run_desktop(desktop);
  return 0;
}

// Refuses options of a simulation: a video shows what is recorded.
void check_no_world(const InputOptions& input) {
  if (!input.device.empty() || !input.scene.empty() || input.set_parameters()) {
    throw UsageError(
        "--video: shows the session as it was recorded; arm, scene and parameters can be given "
        "only for the window (`limpid run --hand SESSION.h5` runs the session again with other "
        "settings)");
  }
}

int play(const WindowOptions& options, const MakeVideo& make_video) {
  if (options.video.out.empty()) return open_window(options);
  check_no_world(options.input);
  if (!options.listen.empty()) throw UsageError("--listen: is an option of the window");
  if (options.desktop.print_state) throw UsageError("--print-state: is an option of the window");
  return make_video(options.session, options.video, options.desktop.ui_scale);
}

}  // namespace

WindowCommands declare_window(CLI::App& app, MakeVideo make_video) {
  auto options = std::make_shared<WindowOptions>();
  app.add_option("FILE", options->files,
                 "to open in the window: a recording, a sweep's folder or table, a scene, a model, "
                 "a hand, an arm")
      ->transform(or_shipped({"scenes", "devices", "sessions", "stories", "hands"}), "", "")
      ->type_name("");
  add(app, *options);
  auto* command = app.add_subcommand(
      "play", "opens the desktop app and plays a recorded session, or makes its video");
  auto played = std::make_shared<WindowOptions>();
  command->add_option("SESSION.h5", played->session, "the recording, or a sweep's table")
      ->transform(or_shipped({"sessions"}), "", "")
      ->type_name("")
      ->required();
  played->video.add(*command);
  add(*command, *played);
  command->footer(
      "A video is drawn picture by picture, without a display. It is written as OUT.part and gets "
      "its\nfinal name at the end; Ctrl-C deletes it. --ui-scale is the size of the text in the "
      "video.");
  return {[options, &app] {
            for (const CLI::App* each : shown_commands(app))
              options->commands.push_back(each->get_name());
            return open_window(*options);
          },
          [options, played, make_video = std::move(make_video)] {
            if (!options->files.empty()) {
              throw UsageError(fmt::format(
                  "\"{}\" stands before the command play; needed: first play, then files",
                  options->files.front()));
            }
            return play(both(*options, *played), make_video);
          }};
}

}  // namespace limpid
