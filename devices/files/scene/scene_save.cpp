#include <fmt/format.h>

#include "devices/files/atomic_file.h"
#include "devices/files/file_error.h"
#include "devices/files/scene/model_units.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/scene/scene_limits.h"
#include "devices/files/scene/scene_writer.h"
#include "devices/files/text_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<unsigned char>;

Bytes read_bytes(const fs::path& file) {
  const std::string text = read_text(file, scene_limits::kLargestModel);
  return {text.begin(), text.end()};
}

// Kinds of models that consist of several files, as a rule.
bool has_companions(const fs::path& file) {
  const std::string suffix = small_suffix(file);
  return suffix == ".gltf" || suffix == ".obj" || suffix == ".dae";
}

// The models of a scene, brought to where its file can name them.
class Models {
 public:
  explicit Models(fs::path folder) : folder_(std::move(folder)) {}
  ~Models() {
    std::error_code none;
    if (!kept_) {
      for (const fs::path& copy : copies_) fs::remove(copy, none);
    }
  }
  Models(const Models&) = delete;
  Models& operator=(const Models&) = delete;

  // The name for a model at `path`, or with these bytes if it has none.
  std::string place(const fs::path& path, const std::string& name, const Bytes* bytes) {
    const auto [known, is_new] = names_.try_emplace(path.empty() ? fs::path(name) : path);
    if (is_new) known->second = find_place(path, name, bytes);
    return known->second;
  }
  void keep() { kept_ = true; }

 private:
  std::string find_place(const fs::path& path, const std::string& name, const Bytes* bytes) {
    std::error_code none;
    const bool there = !path.empty() && fs::is_regular_file(path, none);
    if (there) {
      const fs::path inside = path.lexically_relative(folder_);
      if (!inside.empty() && *inside.begin() != "..") return inside.string();
      if (has_companions(path)) return path.string();
    }
    return bytes != nullptr ? copy(fs::path(name), *bytes) : copy(fs::path(name), read_bytes(path));
  }

  std::string copy(const fs::path& name, const Bytes& bytes) {
    for (int i = 1;; ++i) {
      const std::string number = i == 1 ? "" : fmt::format("-{}", i);
      const fs::path out =
          folder_ / fmt::format("{}{}{}", name.stem().string(), number, name.extension().string());
      std::error_code none;
      if (!fs::exists(fs::symlink_status(out, none))) {
        write_atomically(out, bytes);
        copies_.push_back(out);
        return out.filename().string();
      }
      if (fs::is_regular_file(out, none) && fs::file_size(out, none) == bytes.size() &&
          read_bytes(out) == bytes) {
        return out.filename().string();
      }
    }
  }

  fs::path folder_;
  std::map<fs::path, std::string> names_;
  std::vector<fs::path> copies_;
  bool kept_ = false;
};

}  // namespace

SceneDocument save_scene(const SceneDocument& document, const ArmDescription& arm,
                         const fs::path& file) {
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  std::error_code none;
  if (!fs::is_directory(folder, none)) {
    const std::string why = why_not_found(folder, "there is no folder");
    throw FileError(fmt::format("{}: {}: {}", file.string(), why.empty() ? "not a folder" : why,
                                folder.string()));
  }
  if (fs::is_directory(file, none)) throw FileError(file.string() + ": is a folder");
  SceneDocument out = document;
  out.models.clear();
  Models models(folder);
  for (MeshObstacle& mesh : out.scene.meshes) {
    const ModelFile& model = document.models.at(mesh.model);
    mesh.model = models.place(model.path, mesh.model, model.bytes.get());
    out.models[mesh.model] = {(folder / mesh.model).lexically_normal().string(), model.bytes};
  }
  for (SceneVisual& visual : out.visuals) {
    const std::string name = models.place(visual.file, visual.file, nullptr);
    visual.file = (folder / name).lexically_normal().string();
  }
  out.toml = scene_text(out, arm, folder);
  // What could not be read again never takes the place of what can.
  parse_scene(out.toml, file.string(), folder, arm, files_of(out));
  write_atomically(
      file, std::span(reinterpret_cast<const unsigned char*>(out.toml.data()), out.toml.size()));
  models.keep();
  return out;
}

}  // namespace limpid
