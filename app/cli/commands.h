// The commands; each declares its options on the command line and returns what runs it.
#pragma once

#include <functional>

#include "app/cli/video_options.h"

namespace CLI {
class App;
}

namespace limpid {

// Returns the exit status.
using Command = std::function<int()>;

Command declare_run(CLI::App& app);
Command declare_serve(CLI::App& app);
Command declare_experiment(CLI::App& app);
Command declare_sweep(CLI::App& app);
Command declare_analyze(CLI::App& app);
Command declare_check(CLI::App& app);
Command declare_info(CLI::App& app);
Command declare_recover(CLI::App& app);
Command declare_devices(CLI::App& app);
Command declare_identify(CLI::App& app);
Command declare_doctor(CLI::App& app);
// Not told of: writes what is installed beside the program, made from the other commands.
Command declare_share(CLI::App& app);
Command declare_story(CLI::App& app, MakeVideo make_video);
// The window: `limpid` without a command, and `limpid play`. The options of the app itself are the
// window's and hold for both.
struct WindowCommands {
  Command desktop, play;
};
WindowCommands declare_window(CLI::App& app, MakeVideo make_video);

}  // namespace limpid
