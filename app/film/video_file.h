// Pictures in, a video out: OUT.mp4, OUT.gif, or a folder of PNG files.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "app/film/av.h"

namespace limpid {

struct VideoFormat {
  int width = 1280, height = 720;  // [px], even, kLeastVideo to kLargestVideo
  int fps = 30;                    // pictures a second, 1 to most_fps()
  std::string comment = {};        // in the metadata of files that have any
};
inline constexpr int kLeastVideo = 64, kLargestVideo = 4096;

enum class VideoKind : std::uint8_t { mp4, gif, pictures };

// By the name's ending; none, or a folder that is there, is for pictures. Errors: FileError.
VideoKind video_kind(const std::filesystem::path& out);
int most_fps(VideoKind kind);
// For who does not say.
int usual_fps(VideoKind kind);

// Grows as OUT.part and gets its name at the end. Without finish() nothing of it is left.
class VideoFile {
 public:
  // MP4: H.264 where libavcodec has libx264, MPEG-4 otherwise. A folder must be empty or new; with
  // `force` the pictures of an earlier video in it are replaced, and nothing else is touched.
  // Errors: FileError for a place, name or format that is refused; nothing is written then.
  VideoFile(const std::filesystem::path& out, const VideoFormat& format, bool force);
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  // The next picture: width x height pixels of four bytes, top row first; opaque. Errors:
  // std::runtime_error naming OUT and the reason, such as a full disk.
  void add(std::span<const unsigned char> rgba);

  // Completes the video and gives it its name, unless `stop` becomes true meanwhile: a GIF is only
  // written now, in the colours of all of its pictures, and `at` is told the part that is done.
  // Returns whether the video is there. Errors: as add().
  bool finish(const std::atomic<bool>& stop, const std::function<void(double)>& at);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// A file with one stream of pictures, encoded by FFmpeg's libraries.

// How pictures become a file.
struct Coding {
  const char* container;  // a muxer of libavformat
  const AVCodec* codec;   // null: libavcodec was built without it
  AVPixelFormat pixels;
  AVRational time_base;                                           // of the stream [s]
  std::vector<std::pair<std::string, std::string>> options = {};  // of codec and container
};
Coding mp4_coding(int fps);
Coding gif_coding();
// Every pixel as it was, to be read again.
Coding lossless_coding(int fps);

// Errors: std::runtime_error with the reason alone.
class StreamFile {
 public:
  StreamFile(const std::filesystem::path& file, const VideoFormat& format, const Coding& coding);

  // A picture as VideoFile has it, the one after the last.
  void add(std::span<const unsigned char> rgba);
  // A frame in the coding's pixels, its time in units of the coding's time base.
  void add(const AVFrame& frame) { encode(&frame); }
  void finish();

 private:
  void encode(const AVFrame* frame);  // null: what is still inside

  VideoFormat format_;
  Av<AVFormatContext> file_;
  Av<AVCodecContext> codec_;
  Av<AVFrame> frame_;
  Av<AVPacket> packet_;
  Av<SwsContext> convert_;
  std::int64_t next_ = 0;
};

// A GIF of a video: 256 colours, chosen from all of its pictures.

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
