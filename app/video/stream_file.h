// A file with one stream of pictures, encoded by FFmpeg's libraries.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "app/video/av.h"
#include "app/video/video_file.h"

namespace limpid {

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

}  // namespace limpid
