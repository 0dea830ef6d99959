// `limpid play SESSION.h5 --video OUT`: options, and what they have done.
#pragma once

#include <optional>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace limpid {

struct VideoOptions {
  std::string out;   // empty: no video is asked for
  std::string size;  // WIDTHxHEIGHT
  std::optional<int> fps;
  double from = 0;
  std::optional<double> to;
  double speed = 1;
  bool plots = true;
  bool force = false;
  bool print_progress = false;

  void add(CLI::App& command);
};

// Draws the session's video; returns the exit status. Errors: UsageError, FileError.
int make_video(const std::string& session, const VideoOptions& options, double text_scale);

}  // namespace limpid
