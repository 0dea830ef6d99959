// Unsaved changes of a scene, kept when Limpid is ended from outside and nobody can be asked.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/desktop/base/notices.h"
#include "core/dynamics/arm_description.h"
#include "devices/files/scene/scene_document.h"

namespace limpid {

// Writes the scene, known as `name`, to folder/NAME-unsaved.toml, or beside an older file of that
// name. Returns the file. Errors: FileError and std::filesystem::filesystem_error.
std::filesystem::path keep_unsaved(const SceneDocument& document, const ArmDescription& arm,
                                   const std::string& name, const std::filesystem::path& folder);

// Renames all kept scenes to NAME-recovered.toml, so that each is returned only once. Returns the
// files.
std::vector<std::filesystem::path> take_unsaved(const std::filesystem::path& folder);

// Offers kept scenes to the user, one after the other, the last one first.
class KeptScenes {
 public:
  explicit KeptScenes(Notices& notices) : notices_(notices) {}

  void offer(std::vector<std::filesystem::path> files) { files_ = std::move(files); }
  bool any() const { return !files_.empty(); }
  // Returns the scene that is offered. Precondition of this and all below: any().
  const std::filesystem::path& newest() const { return files_.back(); }
  std::filesystem::path take();  // stops offering it
  void leave();                  // stops offering it; it stays in its folder
  void discard();

 private:
  Notices& notices_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace limpid
