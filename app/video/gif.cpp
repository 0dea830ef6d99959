#include "app/video/gif.h"

#include "app/video/stream_file.h"

extern "C" {
#include <libavfilter/buffersink.h>
#include <libavutil/opt.h>
}

namespace limpid {
namespace {

// lossless -> palettegen ----> paletteuse -> sink
// lossless -------------------^
// The file is opened twice, so that no picture waits in memory for the colours.
class Colours {
 public:
  explicit Colours(const std::filesystem::path& lossless) : graph_(given(avfilter_graph_alloc())) {
    AVFilterContext* generate = node("palettegen", {{"stats_mode", "full"}});
    // Ordered dither stays where it is from picture to picture, and is small in the file.
    AVFilterContext* use =
        node("paletteuse", {{"dither", "bayer"}, {"bayer_scale", "4"}, {"diff_mode", "rectangle"}});
    sink_ = node("buffersink", {});
    const std::string file = av_address(lossless);
    checked(avfilter_link(node("movie", {{"filename", file}}), 0, generate, 0));
    checked(avfilter_link(node("movie", {{"filename", file}}), 0, use, 0));
    checked(avfilter_link(generate, 0, use, 1));
    checked(avfilter_link(use, 0, sink_, 0));
    checked(avfilter_graph_config(graph_.get(), nullptr));
  }

  // The next picture; false after the last.
  bool next(AVFrame& frame) {
    const int got = av_buffersink_get_frame(sink_, &frame);
    if (got == AVERROR_EOF) return false;
    checked(got);
    return true;
  }
  AVRational time_base() const { return av_buffersink_get_time_base(sink_); }

 private:
  AVFilterContext* node(const char* filter,
                        std::initializer_list<std::pair<const char*, std::string>> options) {
    AVFilterContext* made =
        given(avfilter_graph_alloc_filter(graph_.get(), avfilter_get_by_name(filter), nullptr));
    for (const auto& [key, value] : options) {
      checked(av_opt_set(made, key, value.c_str(), AV_OPT_SEARCH_CHILDREN));
    }
    checked(avfilter_init_str(made, nullptr));
    return made;
  }

  Av<AVFilterGraph> graph_;
  AVFilterContext* sink_ = nullptr;
};

}  // namespace

bool write_gif(const std::filesystem::path& lossless, const std::filesystem::path& gif,
               const VideoFormat& format, const std::atomic<bool>& stop) {
  Colours colours(lossless);
  const Coding coding = gif_coding();
  StreamFile out(gif, format, coding);
  const Av<AVFrame> frame(given(av_frame_alloc()));
  while (!stop && colours.next(*frame)) {
    frame->pts = av_rescale_q(frame->pts, colours.time_base(), coding.time_base);
    out.add(*frame);
    av_frame_unref(frame.get());
  }
  if (stop) return false;
  out.finish();
  return true;
}

}  // namespace limpid
