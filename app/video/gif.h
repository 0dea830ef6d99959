// A GIF of a video: 256 colours, chosen from all of its pictures.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>

#include "app/video/video_file.h"

namespace limpid {

// Pictures are kept as they are in a file until the last one is there and the colours are known.
// Errors: std::runtime_error with the reason alone.
class GifFile {
 public:
  GifFile(const std::filesystem::path& kept, const VideoFormat& format);
  ~GifFile();

  // As VideoFile::add().
  void add(std::span<const unsigned char> rgba);
  // False, with an incomplete `gif`, once `stop` is true. `at` is told the part that is done.
  bool finish(const std::filesystem::path& gif, const std::atomic<bool>& stop,
              const std::function<void(double)>& at);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace limpid
