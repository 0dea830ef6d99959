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

// Returns the kind by the name's ending. A name without an ending, or a folder that is there, is
// for pictures. Errors: FileError.
VideoKind video_kind(const std::filesystem::path& out);
int most_fps(VideoKind kind);
// Returns the usual rate, for orders without one.
int usual_fps(VideoKind kind);

// A video made picture by picture. It grows as OUT.part and gets its name at the end; without
// finish() nothing of it is left.
class VideoFile {
 public:
  // Makes MP4 with H.264 where libavcodec has libx264, with MPEG-4 otherwise. A folder must be
  // empty or new; with `force` the pictures of an earlier video in it are replaced, and nothing
  // else is touched. Errors: FileError for a place, name or format that is refused; nothing is
  // written then.
  VideoFile(const std::filesystem::path& out, const VideoFormat& format, bool force);
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  // Adds the next picture: width x height pixels of four bytes, top row first; opaque. Errors:
  // std::runtime_error naming OUT and the reason, such as a full disk.
  void add(std::span<const unsigned char> rgba);

  // Completes the video and gives it its name, unless `stop` becomes true meanwhile. A GIF is only
  // written now, in the colours of all of its pictures, and `at` is told the part that is done.
  // Returns whether the video is there. Errors: as add().
  bool finish(const std::atomic<bool>& stop, const std::function<void(double)>& at);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Coding of pictures into a file.
struct Coding {
  const char* container;  // a muxer of libavformat
  const AVCodec* codec;   // null: libavcodec was built without it
  AVPixelFormat pixels;
  AVRational time_base;                                           // of the stream [s]
  std::vector<std::pair<std::string, std::string>> options = {};  // of codec and container
};
Coding mp4_coding(int fps);
Coding gif_coding();
// Keeps every pixel as it was, to be read again.
Coding lossless_coding(int fps);

// A file with one stream of pictures, encoded by FFmpeg's libraries. Errors: std::runtime_error
// with the reason alone.
class StreamFile {
 public:
  StreamFile(const std::filesystem::path& file, const VideoFormat& format, const Coding& coding);

  // Adds the picture after the last, as VideoFile has it.
  void add(std::span<const unsigned char> rgba);
  // Adds a frame in the coding's pixels, its time in units of the coding's time base.
  void add(const AVFrame& frame) { encode(&frame); }
  void finish();

 private:
  void encode(const AVFrame* frame);  // null: encodes the frames still inside

  VideoFormat format_;
  Av<AVFormatContext> file_;
  Av<AVCodecContext> codec_;
  Av<AVFrame> frame_;
  Av<AVPacket> packet_;
  Av<SwsContext> convert_;
  std::int64_t next_ = 0;
};

// A GIF of 256 colours, chosen from all of its pictures. Keeps the pictures as they are in a file
// until the last one is there and the colours are known. Errors: std::runtime_error with the reason
// alone.
class GifFile {
 public:
  GifFile(const std::filesystem::path& kept, const VideoFormat& format);
  ~GifFile();

  // Adds a picture as VideoFile::add() does.
  void add(std::span<const unsigned char> rgba);
  // Writes the GIF; returns false, with an incomplete `gif`, once `stop` is true. Tells `at` the
  // part that is done.
  bool finish(const std::filesystem::path& gif, const std::atomic<bool>& stop,
              const std::function<void(double)>& at);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace limpid
