// Desktop application.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/tick/parameters.h"

namespace limpid {

struct DesktopOptions {
  std::string device, scene;  // files; empty: as last time
  std::string in_use;         // id of a real device; empty: as last time
  std::string tip;            // a link of the device; empty: as its file has it
  // Makes the parameters from those of the last time; none: they stay.
  std::function<Parameters(const Parameters&)> parameters;
  std::filesystem::path session;             // to play at once
  std::vector<std::filesystem::path> files;  // to open at once, as if dropped
  bool print_state = false;                  // one line of JSON ten times a second
  double ui_scale = 0;                       // 0: the screen's scale
  std::filesystem::path listen;              // a socket for programs; empty: none
  // Says that a program started the window: it ends with standard input and keeps no settings.
  bool until_eof = false;
};

// Runs until the window is closed. Errors: std::runtime_error without a display; FileError and the
// like for unusable files.
void run_desktop(const DesktopOptions& options);

}  // namespace limpid
