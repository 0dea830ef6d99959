#include "render/quality.h"

#include <algorithm>
#include <array>

namespace limpid {
namespace {

constexpr double kSlow = 0.025, kFast = 0.0175;   // [s]
constexpr double kSecond = 1, kLongestFrame = 1;  // [s]
constexpr int kFewestFrames = 3;
constexpr int kFirstWait = 4, kLongestWait = 600;  // [s]

}  // namespace

Quality Quality::level(int level) {
  constexpr std::array<Quality, kLowest + 1> kLevels = {{
      {.msaa = 4, .shadow_size = 2048, .soft = true, .scale = 1, .triangles = 8'000'000},
      {.msaa = 1, .shadow_size = 2048, .soft = true, .scale = 1, .triangles = 2'000'000},
      {.msaa = 1, .shadow_size = 1024, .soft = false, .scale = 1, .triangles = 300'000},
      {.msaa = 1, .shadow_size = 512, .soft = false, .scale = 1, .triangles = 120'000},
      {.msaa = 1, .shadow_size = 0, .soft = false, .scale = 1, .triangles = 60'000},
      {.msaa = 1, .shadow_size = 0, .soft = false, .scale = 0.5, .triangles = 60'000},
  }};
  return kLevels[static_cast<std::size_t>(std::clamp(level, 0, kLowest))];
}

int Quality::automatic_level(std::string_view gl_renderer) {
  for (const char* software : {"llvmpipe", "softpipe", "SWR", "Software Rasterizer"})
    if (gl_renderer.find(software) != std::string_view::npos) return 2;
  return 0;
}

AutoQuality::AutoQuality(int level)
    : level_(std::clamp(level, 0, Quality::kLowest)), wait_(kFirstWait) {}

void AutoQuality::reset() {
  begin_second();
  good_seconds_ = 0;
  wait_ = kFirstWait;
}

void AutoQuality::begin_second() {
  elapsed_ = 0;
  frames_ = slow_ = fast_ = 0;
}

bool AutoQuality::frame(double seconds) {
  if (!(seconds >= 0)) return false;
  elapsed_ += std::min(seconds, kLongestFrame);
  ++frames_;
  slow_ += seconds > kSlow;
  fast_ += seconds < kFast;
  if (elapsed_ < kSecond || frames_ < kFewestFrames) return false;
  const bool bad = 2 * slow_ > frames_, good = 10 * fast_ >= 9 * frames_;
  begin_second();
  good_seconds_ = good ? good_seconds_ + 1 : 0;
  if (bad && level_ < Quality::kLowest) {
    ++level_;
    wait_ = std::min(2 * wait_, kLongestWait);
    return true;
  }
  if (good_seconds_ >= wait_ && level_ > 0) {
    --level_;
    good_seconds_ = 0;
    return true;
  }
  return false;
}

}  // namespace limpid
