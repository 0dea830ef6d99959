// A video, read by FFmpeg's own demuxers and decoders.
#pragma once

#include <array>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "app/film/av.h"

namespace limpid {

using Colour = std::array<double, 3>;  // 0 to 255

struct SeenVideo {
  int width = 0, height = 0;
  double duration = 0;             // [s]
  std::vector<Colour> left = {};   // mean colour of each picture's left half
  std::vector<Colour> right = {};  // mean colour of each picture's right half
  std::vector<double> times = {};  // display time of each picture [s]
};

inline Colour mean_colour(const AVFrame& rgb, int from, int to) {
  Colour sum{};
  for (int y = 0; y < rgb.height; ++y) {
    const std::uint8_t* line = rgb.data[0] + y * rgb.linesize[0];
    for (int x = 3 * from; x < 3 * to; ++x) sum[static_cast<std::size_t>(x % 3)] += line[x];
  }
  for (double& channel : sum) channel /= (to - from) * rgb.height;
  return sum;
}

inline void look_at(const AVFrame& frame, AVRational time_base, SeenVideo& seen) {
  const Av<AVFrame> rgb(given(av_frame_alloc()));
  rgb->format = AV_PIX_FMT_RGB24;
  rgb->width = frame.width;
  rgb->height = frame.height;
  checked(av_frame_get_buffer(rgb.get(), 0));
  const Av<SwsContext> convert(given(sws_getContext(
      frame.width, frame.height, static_cast<AVPixelFormat>(frame.format), frame.width,
      frame.height, AV_PIX_FMT_RGB24, SWS_BICUBIC | SWS_ACCURATE_RND, nullptr, nullptr, nullptr)));
  if (frame.colorspace == AVCOL_SPC_BT709) {
    const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
    sws_setColorspaceDetails(convert.get(), bt709, 0, bt709, 1, 0, 1 << 16, 1 << 16);
  }
  sws_scale(convert.get(), frame.data, frame.linesize, 0, frame.height, rgb->data, rgb->linesize);
  seen.left.push_back(mean_colour(*rgb, 0, frame.width / 2));
  seen.right.push_back(mean_colour(*rgb, frame.width / 2, frame.width));
  seen.times.push_back(static_cast<double>(frame.best_effort_timestamp) * av_q2d(time_base));
}

// Throws std::runtime_error for files that no player would open.
inline SeenVideo read_video(const std::filesystem::path& file) {
  AVFormatContext* opened = nullptr;
  checked(avformat_open_input(&opened, av_address(file).c_str(), nullptr, nullptr));
  const auto close = [](AVFormatContext* f) { avformat_close_input(&f); };
  const std::unique_ptr<AVFormatContext, decltype(close)> input(opened);
  checked(avformat_find_stream_info(input.get(), nullptr));
  if (input->nb_streams != 1) throw std::runtime_error("not one stream");
  const AVStream& stream = *input->streams[0];
  const AVCodec* decoder = given(avcodec_find_decoder(stream.codecpar->codec_id));
  const Av<AVCodecContext> codec(given(avcodec_alloc_context3(decoder)));
  checked(avcodec_parameters_to_context(codec.get(), stream.codecpar));
  checked(avcodec_open2(codec.get(), decoder, nullptr));

  SeenVideo seen{.width = stream.codecpar->width,
                 .height = stream.codecpar->height,
                 .duration = static_cast<double>(input->duration) / AV_TIME_BASE};
  const Av<AVPacket> packet(given(av_packet_alloc()));
  const Av<AVFrame> frame(given(av_frame_alloc()));
  const auto look = [&] {
    while (avcodec_receive_frame(codec.get(), frame.get()) >= 0) {
      look_at(*frame, stream.time_base, seen);
    }
  };
  while (av_read_frame(input.get(), packet.get()) >= 0) {
    checked(avcodec_send_packet(codec.get(), packet.get()));
    av_packet_unref(packet.get());
    look();
  }
  checked(avcodec_send_packet(codec.get(), nullptr));
  look();
  return seen;
}

}  // namespace limpid
