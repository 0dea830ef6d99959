// Process that makes a session's video beside a window.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace limpid {

// Settings of a video.
struct VideoRequest {
  enum class Kind : std::uint8_t { mp4, gif, png };  // png: a folder of pictures

  Kind kind = Kind::mp4;
  int width = 1280, height = 720;  // [px]
  std::optional<int> fps = {};     // none: the usual rate of the kind
  double speed = 1;                // times the session's
  bool plots = true, overlaid = false, lens = false;
  std::vector<std::string> rerun =
      {};                         // settings of a re-run, as "coupling.eta=0.5"; none: no re-run
  double from = 0;                // beginning in the session [s]
  std::optional<double> to = {};  // end in the session [s]; none: its end
};

// Returns the options of `limpid play` for such a video.
std::vector<std::string> words_of(const VideoRequest& order);
// Returns a free name beside the session's file or, if that folder cannot be written, in
// `otherwise`.
std::filesystem::path video_of(const std::filesystem::path& session, VideoRequest::Kind kind,
                               const std::filesystem::path& otherwise);

// Runs `limpid play SESSION --video OUT` with these `options` at low priority, and waits for it. It
// is a process of its own as ImGui serves only one thread of a program, and the loop keeps its
// processor. Sets `part` to the part that is done, 0 to 1. Returns false once `stop` is true and
// the process has cleared up. Errors: std::runtime_error with the process's words.
bool film_beside(const std::filesystem::path& session, const std::filesystem::path& out,
                 const std::vector<std::string>& options, const std::atomic<bool>& stop,
                 std::atomic<double>& part);

}  // namespace limpid
