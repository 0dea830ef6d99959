#include "app/session/video_request.h"

#include <fmt/format.h>
#include <unistd.h>

namespace limpid {

namespace fs = std::filesystem;

std::vector<std::string> words_of(const VideoRequest& request) {
  std::vector<std::string> words{"--size",  fmt::format("{}x{}", request.width, request.height),
                                 "--speed", fmt::format("{}", request.speed),
                                 "--from",  fmt::format("{}", request.from)};
  const auto add = [&](const char* option, const auto& value) {
    if (value) words.insert(words.end(), {option, fmt::format("{}", *value)});
  };
  add("--fps", request.fps);
  add("--to", request.to);
  if (!request.plots) words.emplace_back("--no-plots");
  if (request.overlaid) words.emplace_back("--overlaid");
  return words;
}

fs::path video_of(const fs::path& session, VideoRequest::Kind kind, const fs::path& otherwise) {
  const bool writable = ::access(fs::absolute(session).parent_path().c_str(), W_OK) == 0;
  const fs::path folder = writable ? session.parent_path() : otherwise;
  const char* end = kind == VideoRequest::Kind::mp4   ? ".mp4"
                    : kind == VideoRequest::Kind::gif ? ".gif"
                                                      : "-pictures";
  const std::string stem = session.stem().string();
  fs::path out = folder / (stem + end);
  for (int i = 2; fs::exists(out); ++i) out = folder / fmt::format("{}-{}{}", stem, i, end);
  return out;
}

}  // namespace limpid
