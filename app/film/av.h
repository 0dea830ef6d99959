// Owners of objects that FFmpeg's libraries allocate, and their errors in words.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavfilter/avfilter.h>
#include <libavfilter/buffersink.h>
#include <libavfilter/buffersrc.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

namespace limpid {

struct AvDeleter {
  void operator()(AVFormatContext* file) const {
    avio_closep(&file->pb);
    avformat_free_context(file);
  }
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(AVFilterGraph* graph) const { avfilter_graph_free(&graph); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};
template <class T>
using Av = std::unique_ptr<T, AvDeleter>;

// Returns the result of a call, if that is no error. Errors: std::runtime_error.
inline int checked(int result) {
  if (result >= 0) return result;
  char why[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(result, why, sizeof why);
  throw std::runtime_error(why);
}

template <class T>
T* given(T* made) {
  if (made == nullptr) throw std::runtime_error(std::strerror(ENOMEM));
  return made;
}

// Returns the address of a file, whatever its letters, and never of something else.
inline std::string av_address(const std::filesystem::path& file) { return "file:" + file.string(); }

}  // namespace limpid
