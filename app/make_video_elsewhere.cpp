#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "app/make_video.h"

namespace limpid {
namespace {

int in_other_program(char** words) {
  const auto program =
      std::filesystem::read_symlink("/proc/self/exe").replace_filename("limpid-video");
  ::execv(program.c_str(), words);
  throw std::runtime_error(
      fmt::format("{}, which makes videos: {}", program.string(), std::strerror(errno)));
}

}  // namespace

int make_video(const std::string& /*session*/, const VideoOptions& /*options*/,
               double /*text_scale*/, char** words) {
  return in_other_program(words);
}

int make_story_video(const std::string& /*script*/, const VideoOptions& /*options*/, char** words) {
  return in_other_program(words);
}

}  // namespace limpid
