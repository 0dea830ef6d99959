#include "app/video/gif.h"

#include <fmt/format.h>

#include <cstring>
#include <optional>

#include "app/video/stream_file.h"

extern "C" {
#include <libavfilter/buffersink.h>
#include <libavfilter/buffersrc.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

namespace limpid {
namespace {

using Options = std::initializer_list<std::pair<const char*, std::string>>;

// Filters of libavfilter, one behind the other, that end in a sink.
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
  // Where frames of this kind are put in.
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

  // The next frame out of the sink; false after the last.
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

}  // namespace

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

  // kept pictures -> paletteuse -> sink, with the colours as its second input.
  void use_colours(Filters& filters) {
    const Av<AVFrame> colours(given(av_frame_alloc()));
    checked(av_buffersrc_add_frame(source, nullptr));
    if (!palette.next(*colours)) throw std::runtime_error("there is no picture");
    AVFilterContext* pictures_in = filters.node("movie", {{"filename", av_address(kept)}});
    AVFilterContext* colours_in = filters.source(colours->width, colours->height,
                                                 static_cast<AVPixelFormat>(colours->format));
    // Ordered dither stays where it is from picture to picture, and is small in the file.
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

}  // namespace limpid
