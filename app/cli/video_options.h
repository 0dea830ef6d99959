// Options of `limpid play SESSION.h5 --video OUT`.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace limpid {

struct VideoOptions {
  std::string out;   // empty: no video
  std::string size;  // WIDTHxHEIGHT
  std::optional<int> fps;
  double from = 0;
  std::optional<double> to;
  double speed = 1;
  bool plots = true;
  bool overlaid = false;
  bool lens = false;
  std::vector<std::string> rerun;  // settings of a re-run; none: no re-run
  bool force = false;
  bool print_progress = false;

  void add(CLI::App& command);
};

// Makes the session's video; `text_scale` 0: in proportion to the size. Returns the exit status.
// Errors: UsageError, FileError.
using MakeVideo =
    std::function<int(const std::string& session, const VideoOptions& options, double text_scale)>;

}  // namespace limpid
