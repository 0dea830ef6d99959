// Commands of the program: each declares its options and returns the function that runs it.
#pragma once

#include <functional>
#include <vector>

#include "app/cli/manual_page.h"
#include "app/cli/video_options.h"

namespace CLI {
class App;
}

namespace limpid {

// Runs a command; returns the exit status.
using Command = std::function<int()>;

Command declare_run(CLI::App& app);
Command declare_serve(CLI::App& app);
Command declare_experiment(CLI::App& app);
Command declare_sweep(CLI::App& app);
Command declare_analyze(CLI::App& app);
Command declare_characterize(CLI::App& app);
Command declare_check(CLI::App& app);
Command declare_info(CLI::App& app);
Command declare_recover(CLI::App& app);
Command declare_devices(CLI::App& app);
Command declare_look(CLI::App& devices);  // below `devices`
Command declare_identify(CLI::App& app);
Command declare_doctor(CLI::App& app);
// Hidden: writes what is installed beside the program, from the other commands and these keys.
Command declare_share(CLI::App& app, std::vector<ManualKey> keys);
Command declare_manual(CLI::App& app);
Command declare_story(CLI::App& app, MakeVideo make_video);

}  // namespace limpid
