#include "app/desktop/scene/unsaved.h"

#include <fmt/format.h>

#include <algorithm>

#include "devices/files/scene/scene_writer.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kUnsaved = "-unsaved";

// Returns folder/STEM.toml, or the first of STEM-2.toml and so on that does not exist.
fs::path free_name(const fs::path& folder, const std::string& stem) {
  fs::path file = folder / (stem + ".toml");
  for (int number = 2; fs::exists(file); ++number) {
    file = folder / fmt::format("{}-{}.toml", stem, number);
  }
  return file;
}

}  // namespace

fs::path keep_unsaved(const SceneDocument& document, const ArmDescription& arm,
                      const std::string& name, const fs::path& folder) {
  fs::create_directories(folder);
  fs::path file = free_name(folder, name + std::string(kUnsaved));
  save_scene(document, arm, file);
  return file;
}

std::vector<fs::path> take_unsaved(const fs::path& folder) {
  std::vector<fs::path> kept;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() == ".toml" && stem.find(kUnsaved) != std::string::npos) {
      kept.push_back(entry.path());
    }
  }
  const auto written = [](const fs::path& file) {
    std::error_code gone;
    return fs::last_write_time(file, gone);
  };
  std::ranges::sort(kept, {}, written);
  for (fs::path& file : kept) {
    const std::string stem = file.stem().string();
    const fs::path scene = free_name(folder, stem.substr(0, stem.find(kUnsaved)) + "-recovered");
    fs::rename(file, scene, none);
    if (!none) file = scene;
  }
  return kept;
}

std::filesystem::path KeptScenes::take() {
  std::filesystem::path file = newest();
  files_.pop_back();
  return file;
}

void KeptScenes::leave() {
  notices_.say(fmt::format("{} is in the gallery (Ctrl+G).", take().filename().string()));
}

void KeptScenes::discard() {
  const std::filesystem::path file = take();
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error) {
    notices_.say(fmt::format("{}: {}", file.string(), error.message()), true);
  } else {
    notices_.say(fmt::format("{} was deleted.", file.filename().string()));
  }
}

}  // namespace limpid
