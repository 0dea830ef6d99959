// Changes of a scene that nobody could be asked about, because Limpid was ended from outside.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/desktop/base/notices.h"
#include "core/dynamics/arm_description.h"
#include "devices/files/scene/scene_document.h"

namespace limpid {

// Writes the scene, known as `name`, to folder/NAME-unsaved.toml, or beside one of an earlier time.
// Returns the file. Errors: FileError and std::filesystem::filesystem_error.
std::filesystem::path keep_unsaved(const SceneDocument& document, const ArmDescription& arm,
                                   const std::string& name, const std::filesystem::path& folder);

// What was kept so, each once: from then on it is a scene like others, NAME-recovered.toml.
std::vector<std::filesystem::path> take_unsaved(const std::filesystem::path& folder);

// Those that are offered to the user, one after the other, the newest first.
class KeptScenes {
 public:
  explicit KeptScenes(Notices& notices) : notices_(notices) {}

  void offer(std::vector<std::filesystem::path> files) { files_ = std::move(files); }
  bool any() const { return !files_.empty(); }
  // Precondition of the others: any().
  const std::filesystem::path& newest() const { return files_.back(); }
  std::filesystem::path take();  // it is no longer offered
  void leave();                  // in its folder, for another time
  void discard();

 private:
  Notices& notices_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace limpid
