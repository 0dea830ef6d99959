#include "app/video/stream_file.h"

#include <fmt/format.h>

namespace limpid {
namespace {

class Dictionary {
 public:
  explicit Dictionary(const Coding& coding) {
    for (const auto& [key, value] : coding.options) {
      av_dict_set(&entries_, key.c_str(), value.c_str(), 0);
    }
  }
  ~Dictionary() { av_dict_free(&entries_); }
  Dictionary(const Dictionary&) = delete;
  Dictionary& operator=(const Dictionary&) = delete;
  AVDictionary** get() { return &entries_; }

 private:
  AVDictionary* entries_ = nullptr;
};

bool subsampled(AVPixelFormat pixels) { return pixels == AV_PIX_FMT_YUV420P; }

// Players take what says nothing for BT.601 or BT.709 as they like: it is said, and held to.
void say_colours(AVCodecContext& codec) {
  if (!subsampled(codec.pix_fmt)) return;
  codec.colorspace = AVCOL_SPC_BT709;
  codec.color_primaries = AVCOL_PRI_BT709;
  codec.color_trc = AVCOL_TRC_BT709;
  codec.color_range = AVCOL_RANGE_MPEG;
}

Av<SwsContext> converter(const VideoFormat& format, AVPixelFormat to) {
  constexpr int kExact = SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP;
  Av<SwsContext> convert(
      given(sws_getContext(format.width, format.height, AV_PIX_FMT_RGBA, format.width,
                           format.height, to, kExact, nullptr, nullptr, nullptr)));
  if (subsampled(to)) {
    const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
    constexpr int kOne = 1 << 16;
    sws_setColorspaceDetails(convert.get(), bt709, 1, bt709, 0, 0, kOne, kOne);
  }
  return convert;
}

}  // namespace

Coding mp4_coding(int fps) {
  Coding coding{.container = "mp4",
                .codec = avcodec_find_encoder_by_name("libx264"),
                .pixels = AV_PIX_FMT_YUV420P,
                .time_base = {1, fps},
                .options = {{"movflags", "+faststart"}, {"g", std::to_string(2 * fps)}}};
  if (coding.codec != nullptr) {
    coding.options.insert(coding.options.end(), {{"preset", "medium"}, {"crf", "18"}});
  } else {
    coding.codec = avcodec_find_encoder(AV_CODEC_ID_MPEG4);
    coding.options.insert(coding.options.end(),
                          {{"flags", "+qscale"}, {"global_quality", "3*QP2LAMBDA"}});
  }
  return coding;
}

Coding gif_coding() {
  return {.container = "gif",
          .codec = avcodec_find_encoder(AV_CODEC_ID_GIF),
          .pixels = AV_PIX_FMT_PAL8,
          .time_base = {1, 100}};
}

Coding lossless_coding(int fps) {
  return {.container = "nut",
          .codec = avcodec_find_encoder(AV_CODEC_ID_FFV1),
          .pixels = AV_PIX_FMT_BGR0,
          .time_base = {1, fps}};
}

StreamFile::StreamFile(const std::filesystem::path& file, const VideoFormat& format,
                       const Coding& coding)
    : format_(format), packet_(given(av_packet_alloc())) {
  if (coding.codec == nullptr) {
    throw std::runtime_error(
        fmt::format("libavcodec has no encoder for {} files here", coding.container));
  }
  const std::string address = av_address(file);
  AVFormatContext* made = nullptr;
  checked(avformat_alloc_output_context2(&made, nullptr, coding.container, address.c_str()));
  file_.reset(made);

  codec_.reset(given(avcodec_alloc_context3(coding.codec)));
  codec_->width = format.width;
  codec_->height = format.height;
  codec_->pix_fmt = coding.pixels;
  codec_->time_base = coding.time_base;
  codec_->framerate = {format.fps, 1};
  codec_->thread_count = 0;  // as many as there are processors
  say_colours(*codec_);
  if ((file_->oformat->flags & AVFMT_GLOBALHEADER) != 0) {
    codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  }
  Dictionary options(coding);
  checked(avcodec_open2(codec_.get(), coding.codec, options.get()));

  AVStream* stream = given(avformat_new_stream(file_.get(), nullptr));
  stream->time_base = codec_->time_base;
  stream->avg_frame_rate = codec_->framerate;
  checked(avcodec_parameters_from_context(stream->codecpar, codec_.get()));
  checked(avio_open(&file_->pb, address.c_str(), AVIO_FLAG_WRITE));
  checked(avformat_write_header(file_.get(), options.get()));
}

void StreamFile::add(std::span<const unsigned char> rgba) {
  const std::size_t line = 4 * static_cast<std::size_t>(format_.width);
  if (rgba.size() != line * static_cast<std::size_t>(format_.height)) {
    throw std::invalid_argument("a picture's size and the video's do not agree");
  }
  if (!frame_) {
    convert_ = converter(format_, codec_->pix_fmt);
    frame_.reset(given(av_frame_alloc()));
    frame_->format = codec_->pix_fmt;
    frame_->width = format_.width;
    frame_->height = format_.height;
    checked(av_frame_get_buffer(frame_.get(), 0));
  }
  checked(av_frame_make_writable(frame_.get()));  // the encoder may still hold the last one
  const std::uint8_t* planes[] = {rgba.data()};
  const int lines[] = {static_cast<int>(line)};
  sws_scale(convert_.get(), planes, lines, 0, format_.height, frame_->data, frame_->linesize);
  frame_->pts = next_++;
  encode(frame_.get());
}

void StreamFile::encode(const AVFrame* frame) {
  checked(avcodec_send_frame(codec_.get(), frame));
  AVStream* stream = file_->streams[0];
  while (true) {
    const int got = avcodec_receive_packet(codec_.get(), packet_.get());
    if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return;
    checked(got);
    packet_->stream_index = 0;
    av_packet_rescale_ts(packet_.get(), codec_->time_base, stream->time_base);
    checked(av_interleaved_write_frame(file_.get(), packet_.get()));
  }
}

void StreamFile::finish() {
  encode(nullptr);
  checked(av_write_trailer(file_.get()));
  checked(avio_closep(&file_->pb));
}

}  // namespace limpid
