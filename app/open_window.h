// The window as a command.
#pragma once

#include "app/cli/commands.h"

namespace limpid {

// The window: `limpid` without a command, and `limpid play`. Both take the options of the app
// itself.
struct WindowCommands {
  Command desktop, play;
};
WindowCommands declare_window(CLI::App& app, MakeVideo make_video);

}  // namespace limpid
