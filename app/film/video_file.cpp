#include "app/film/video_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "devices/files/atomic_file.h"
#include "devices/files/text_file.h"
#include "render/gl/offscreen.h"

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

// Names the colours, BT.709, which the converter keeps to. Without a name players take them for
// BT.601 or BT.709 as they like.
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

using Options = std::initializer_list<std::pair<const char*, std::string>>;

// Filters of libavfilter in a row that ends in a sink.
class Filters {
 public:
  Filters() : graph_(given(avfilter_graph_alloc())), sink_(node("buffersink", {})) {}

  AVFilterContext* node(const char* filter, Options options) {
    AVFilterContext* made =
        given(avfilter_graph_alloc_filter(graph_.get(), avfilter_get_by_name(filter), nullptr));
    for (const auto& [key, value] : options) {
      checked(av_opt_set(made, key, value.c_str(), AV_OPT_SEARCH_CHILDREN));
    }
    checked(avfilter_init_str(made, nullptr));
    return made;
  }
  // Adds a source, into which frames of this kind are put.
  AVFilterContext* source(int width, int height, AVPixelFormat pixels) {
    return node("buffer", {{"video_size", fmt::format("{}x{}", width, height)},
                           {"pix_fmt", av_get_pix_fmt_name(pixels)},
                           {"time_base", "1/100"}});
  }
  static void link(AVFilterContext* from, AVFilterContext* to, unsigned input = 0) {
    checked(avfilter_link(from, 0, to, input));
  }
  void end_with(AVFilterContext* last) {
    link(last, sink_);
    checked(avfilter_graph_config(graph_.get(), nullptr));
  }

  // Takes the next frame out of the sink; false after the last.
  bool next(AVFrame& frame) {
    const int got = av_buffersink_get_frame(sink_, &frame);
    if (got == AVERROR_EOF) return false;
    checked(got);
    return true;
  }
  AVRational time_base() const { return av_buffersink_get_time_base(sink_); }

 private:
  Av<AVFilterGraph> graph_;
  AVFilterContext* sink_;
};

namespace fs = std::filesystem;

constexpr const char* kPicture = "frame-";

fs::path picture_file(const fs::path& folder, std::uint64_t number) {
  return folder / fmt::format("{}{:06}.png", kPicture, number);
}

// Lists the pictures of this video or an earlier one; other files there are the user's.
std::vector<fs::path> pictures_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kPicture) && name.ends_with(".png")) files.push_back(entry.path());
  }
  return files;
}

fs::path frames_of(const fs::path& part) { return fs::path(part) += ".frames"; }

void check_format(const fs::path& out, const VideoFormat& format, VideoKind kind) {
  const auto even = [](int n) { return n >= kLeastVideo && n <= kLargestVideo && n % 2 == 0; };
  if (!even(format.width) || !even(format.height)) {
    throw FileError(
        fmt::format("{}: a video of {} x {} pixels; allowed: even numbers from {} to {}",
                    out.string(), format.width, format.height, kLeastVideo, kLargestVideo));
  }
  if (format.fps < 1 || format.fps > most_fps(kind)) {
    throw FileError(fmt::format("{}: {} pictures per second; allowed: 1 to {}", out.string(),
                                format.fps, most_fps(kind)));
  }
}

// Checks that a folder for pictures is there, or can be.
void check_pictures(const fs::path& folder, bool force) {
  std::error_code error;
  check_name(folder);
  if (!fs::exists(folder, error)) return check_folder(folder);
  if (!fs::is_directory(folder, error)) {
    throw FileError(fmt::format("{}: not a directory", folder.string()));
  }
  if (!force && !fs::is_empty(folder, error)) {
    throw FileError(
        fmt::format("{}: is not empty; --force replaces the pictures of an earlier "
                    "video in it",
                    folder.string()));
  }
  check_folder(folder / kPicture);
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
  if (!format.comment.empty()) {
    checked(av_dict_set(&file_->metadata, "comment", format.comment.c_str(), 0));
  }
  checked(avio_open(&file_->pb, address.c_str(), AVIO_FLAG_WRITE));
  checked(avformat_write_header(file_.get(), options.get()));
}

void StreamFile::add(std::span<const unsigned char> rgba) {
  const std::size_t line = 4 * static_cast<std::size_t>(format_.width);
  if (rgba.size() != line * static_cast<std::size_t>(format_.height)) {
    throw std::invalid_argument("the size of a picture differs from the size of the video");
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

struct GifFile::Impl {
  Impl(const std::filesystem::path& file, const VideoFormat& video)
      : kept(file), format(video), stream(std::in_place, file, video, lossless_coding(video.fps)) {
    source = palette.source(video.width, video.height, AV_PIX_FMT_RGBA);
    AVFilterContext* generate = palette.node("palettegen", {{"stats_mode", "full"}});
    Filters::link(source, generate);
    palette.end_with(generate);
  }

  void count_colours(std::span<const unsigned char> rgba) {
    const Av<AVFrame> frame(given(av_frame_alloc()));
    frame->format = AV_PIX_FMT_RGBA;
    frame->width = format.width;
    frame->height = format.height;
    frame->pts = pictures;
    checked(av_frame_get_buffer(frame.get(), 0));
    const std::size_t line = 4 * static_cast<std::size_t>(format.width);
    for (int y = 0; y < format.height; ++y) {
      std::memcpy(frame->data[0] + y * frame->linesize[0],
                  rgba.data() + static_cast<std::size_t>(y) * line, line);
    }
    checked(av_buffersrc_add_frame(source, frame.get()));
  }

  // Builds kept pictures -> paletteuse -> sink, with the colours as its second input.
  void use_colours(Filters& filters) {
    const Av<AVFrame> colours(given(av_frame_alloc()));
    checked(av_buffersrc_add_frame(source, nullptr));
    if (!palette.next(*colours)) throw std::runtime_error("there is no picture");
    AVFilterContext* pictures_in = filters.node("movie", {{"filename", av_address(kept)}});
    AVFilterContext* colours_in = filters.source(colours->width, colours->height,
                                                 static_cast<AVPixelFormat>(colours->format));
    // Ordered dither stays in place from picture to picture, and is small in the file.
    AVFilterContext* use = filters.node(
        "paletteuse", {{"dither", "bayer"}, {"bayer_scale", "4"}, {"diff_mode", "rectangle"}});
    Filters::link(pictures_in, use, 0);
    Filters::link(colours_in, use, 1);
    filters.end_with(use);
    checked(av_buffersrc_add_frame(colours_in, colours.get()));
    checked(av_buffersrc_add_frame(colours_in, nullptr));
  }

  std::filesystem::path kept;
  VideoFormat format;
  std::optional<StreamFile> stream;
  Filters palette;
  AVFilterContext* source = nullptr;
  std::int64_t pictures = 0;
};

GifFile::GifFile(const std::filesystem::path& kept, const VideoFormat& format)
    : impl_(std::make_unique<Impl>(kept, format)) {}
GifFile::~GifFile() = default;

void GifFile::add(std::span<const unsigned char> rgba) {
  impl_->stream->add(rgba);
  impl_->count_colours(rgba);
  ++impl_->pictures;
}

bool GifFile::finish(const std::filesystem::path& gif, const std::atomic<bool>& stop,
                     const std::function<void(double)>& at) {
  impl_->stream->finish();
  impl_->stream.reset();
  Filters filters;
  impl_->use_colours(filters);
  const Coding coding = gif_coding();
  StreamFile out(gif, impl_->format, coding);
  const Av<AVFrame> frame(given(av_frame_alloc()));
  for (double done = 1; !stop && filters.next(*frame); ++done) {
    frame->pts = av_rescale_q(frame->pts, filters.time_base(), coding.time_base);
    out.add(*frame);
    av_frame_unref(frame.get());
    at(done / static_cast<double>(impl_->pictures));
  }
  if (stop) return false;
  out.finish();
  return true;
}

VideoKind video_kind(const fs::path& out) {
  std::error_code none;
  std::string ending = out.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (fs::is_directory(out, none)) return VideoKind::pictures;
  if (ending == ".mp4") return VideoKind::mp4;
  if (ending == ".gif") return VideoKind::gif;
  if (ending.empty()) return VideoKind::pictures;
  throw FileError(fmt::format(
      "{}: not the name of a video; allowed: OUT.mp4, OUT.gif, or a folder for pictures",
      out.string()));
}

// A GIF counts in hundredths of a second, and viewers slow down pictures shown for one only.
int most_fps(VideoKind kind) { return kind == VideoKind::gif ? 50 : 240; }
int usual_fps(VideoKind kind) { return kind == VideoKind::gif ? 15 : 30; }

struct VideoFile::Impl {
  fs::path out, part;
  VideoFormat format;
  VideoKind kind;
  bool force;
  std::optional<StreamFile> stream;
  std::optional<GifFile> gif;
  std::uint64_t pictures = 0;

  // Does work once writing has begun; errors name OUT.
  template <class Work>
  auto attempt(Work&& work) {
    try {
      return work();
    } catch (const std::runtime_error& e) {
      throw std::runtime_error(
          fmt::format("{}: the video cannot be written: {}", out.string(), e.what()));
    }
  }

  void remove_part() const {
    std::error_code none;
    if (kind == VideoKind::pictures) {
      for (const fs::path& file : pictures_in(part)) fs::remove(file, none);
    }
    fs::remove(part, none);
    fs::remove(frames_of(part), none);
  }

  void open() {
    if (kind == VideoKind::pictures) {
      fs::create_directory(part);
    } else if (kind == VideoKind::gif) {
      gif.emplace(frames_of(part), format);
    } else {
      stream.emplace(part, format, mp4_coding(format.fps));
    }
  }

  void publish_pictures() const {
    if (!fs::exists(out)) return fs::rename(part, out);
    if (!force && !fs::is_empty(out))
      throw std::runtime_error("the folder is no longer empty: other files were written into it");
    for (const fs::path& file : pictures_in(out)) fs::remove(file);
    for (const fs::path& file : pictures_in(part)) fs::rename(file, out / file.filename());
  }
};

VideoFile::VideoFile(const fs::path& out, const VideoFormat& format, bool force)
    : impl_(std::make_unique<Impl>()) {
  // The name of a folder may end in a slash, which OUT.part must not go behind.
  impl_->out = out.has_filename() ? out : out.parent_path();
  impl_->part = part_of(impl_->out);
  impl_->format = format;
  impl_->kind = video_kind(impl_->out);
  impl_->force = force;
  check_format(impl_->out, format, impl_->kind);
  if (impl_->kind == VideoKind::pictures) {
    check_pictures(impl_->out, force);
  } else {
    check_place(impl_->out, force);
  }
  av_log_set_level(AV_LOG_QUIET);  // errors are thrown
  impl_->remove_part();
  try {
    impl_->open();
  } catch (const std::runtime_error& e) {
    impl_->remove_part();
    throw FileError(fmt::format("{}: cannot be written: {}", impl_->out.string(), e.what()));
  }
}

VideoFile::~VideoFile() {
  impl_->stream.reset();
  impl_->gif.reset();
  impl_->remove_part();
}

void VideoFile::add(std::span<const unsigned char> rgba) {
  Impl& v = *impl_;
  v.attempt([&] {
    if (v.stream) return v.stream->add(rgba);
    if (v.gif) return v.gif->add(rgba);
    write_png(picture_file(v.part, ++v.pictures), v.format.width, v.format.height,
              {rgba.begin(), rgba.end()});
  });
}

bool VideoFile::finish(const std::atomic<bool>& stop, const std::function<void(double)>& at) {
  Impl& v = *impl_;
  return v.attempt([&] {
    if (v.gif && !v.gif->finish(v.part, stop, at)) return false;
    if (v.stream) v.stream->finish();
    if (stop) return false;
    if (v.kind == VideoKind::pictures) {
      v.publish_pictures();
    } else {
      publish(v.part, v.out, v.force);
    }
    return true;
  });
}

}  // namespace limpid
