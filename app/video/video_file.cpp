#include "app/video/video_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>
#include <vector>

#include "app/video/gif.h"
#include "app/video/stream_file.h"
#include "devices/files/file_error.h"
#include "devices/files/place.h"
#include "render/gl/offscreen.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPicture = "frame-";

fs::path picture_file(const fs::path& folder, std::uint64_t number) {
  return folder / fmt::format("{}{:06}.png", kPicture, number);
}

// Of this video or an earlier one; what else lies there is somebody's.
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
    throw FileError(fmt::format("{}: {} pictures a second; allowed: 1 to {}", out.string(),
                                format.fps, most_fps(kind)));
  }
}

// A folder for pictures that is there, or can be.
void check_pictures(const fs::path& folder, bool force) {
  std::error_code error;
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

// A GIF counts in hundredths of a second, and viewers slow down what is shown for one only.
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

  // What goes wrong once writing has begun.
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
      throw std::runtime_error("the folder has been filled meanwhile");
    for (const fs::path& file : pictures_in(out)) fs::remove(file);
    for (const fs::path& file : pictures_in(part)) fs::rename(file, out / file.filename());
  }
};

VideoFile::VideoFile(const fs::path& out, const VideoFormat& format, bool force)
    : impl_(std::make_unique<Impl>()) {
  // A folder's name may end in a slash, which OUT.part must not go behind.
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
  av_log_set_level(AV_LOG_QUIET);  // what matters is thrown
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
