// A session's video made beside a window, by a process of its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace limpid {

// A video as it is asked for in the window.

struct VideoRequest {
  enum class Kind : std::uint8_t { mp4, gif, png };  // png: a folder of them

  Kind kind = Kind::mp4;
  int width = 1280, height = 720;  // [px]
  std::optional<int> fps = {};     // none: what is usual for the kind
  double speed = 1;                // of the session
  bool plots = true, overlaid = false;
  double from = 0;                // [s] of the session
  std::optional<double> to = {};  // none: its end
};

// The options of `limpid play` that say so.
std::vector<std::string> words_of(const VideoRequest& order);
// A name that is free, beside the session's file or, where nothing can be written, in `otherwise`.
std::filesystem::path video_of(const std::filesystem::path& session, VideoRequest::Kind kind,
                               const std::filesystem::path& otherwise);

// Runs `limpid play SESSION --video OUT` with these `options` at low priority and waits for it:
// ImGui serves one thread of a program only, and the loop keeps its processor. `part` is set to
// what is done, 0 to 1. Returns false once `stop` is true and the process has cleared up. Errors:
// std::runtime_error with what the process said.
bool film_beside(const std::filesystem::path& session, const std::filesystem::path& out,
                 const std::vector<std::string>& options, const std::atomic<bool>& stop,
                 std::atomic<double>& part);

}  // namespace limpid
