#include "app/desktop/base/thumbnails.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/folders.h"
#include "render/damage.h"
#include "render/gl/offscreen.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

fs::path thumbnails_dir() { return user_cache_dir() / "thumbnails"; }

// Returns a view of the arms alone: arrows and flashes would hide them in so small a picture.
ViewState view_of(const Stage& stage, std::span<const double> row) {
  ViewState view = stage.rows().view(stage.channels().layout(), row);
  view.show_hand = view.show_forces = false;
  return view;
}

std::vector<unsigned char> small_picture(Stage& stage, LaneRows rows, Theme theme) {
  ViewState view = view_of(stage, rows[kMainLane]);
  for (const std::span<const double> other : rows.subspan(1)) lay_over(view, view_of(stage, other));
  view.theme = theme;
  Camera camera;
  camera.resize(kThumbnailWidth, kThumbnailHeight);
  camera.reset(stage.picture.bounds());
  camera.finish();
  return drawn_rgba(kThumbnailWidth, kThumbnailHeight, [&] {
    stage.picture.draw(view, camera, 0, 0, kThumbnailWidth, kThumbnailHeight,
                       SceneView::Sheet::small);
  });
}

}  // namespace

fs::path thumbnail_of(const fs::path& session) {
  const std::string name = fs::absolute(session).lexically_normal().string();
  return thumbnails_dir() / fmt::format("{:016x}.png", hash_of(std::as_bytes(std::span(name))));
}

fs::path picture_of(const fs::path& file) {
  const std::string name = file.stem().string() + ".png";
  if (file.extension() == ".toml") return file.parent_path() / "thumbnails" / name;
  std::error_code none;
  const fs::path shipped = file.parent_path().parent_path() / "scenes/thumbnails" / name;
  const fs::path made = thumbnail_of(file);
  return fs::exists(made, none) || !fs::exists(shipped, none) ? made : shipped;
}

void make_thumbnail(const fs::path& session, Stage& stage, LaneRows rows, Theme theme) {
  try {
    fs::create_directories(thumbnails_dir());
    write_png(thumbnail_of(session), kThumbnailWidth, kThumbnailHeight,
              small_picture(stage, rows, theme));
    keep_newest(thumbnails_dir(), kMostThumbnails);
  } catch (const std::exception&) {
    std::error_code none;
    fs::remove(thumbnail_of(session), none);  // a part, if the disk is full
  }
}

void keep_newest(const fs::path& folder, std::size_t most) {
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().extension() == ".png") files.emplace_back(entry.last_write_time(none), entry);
  }
  if (files.size() <= most) return;
  std::ranges::sort(files, std::greater{});
  for (const auto& [time, file] : std::span(files).subspan(most)) fs::remove(file, none);
}

}  // namespace limpid
