// A video as it is asked for in the window.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace limpid {

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

}  // namespace limpid
