// A GIF of a video: 256 colours, chosen from all of its pictures.
#pragma once

#include <atomic>
#include <filesystem>

#include "app/video/video_file.h"

namespace limpid {

// Reads `lossless` twice, once for the colours and once for the pictures. Returns false, with an
// incomplete `gif`, once `stop` is true. Errors: std::runtime_error with the reason alone.
bool write_gif(const std::filesystem::path& lossless, const std::filesystem::path& gif,
               const VideoFormat& format, const std::atomic<bool>& stop);

}  // namespace limpid
