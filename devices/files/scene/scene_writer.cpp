#include "devices/files/scene/scene_writer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "core/base/model_kinds.h"
#include "devices/files/atomic_file.h"
#include "devices/files/scene/scene_document.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/text_file.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostCompanions = 1000;

// The file names in a line of a model or its materials; empty if the line names no files.
std::string_view named_in(std::string_view line, bool materials) {
  line = trimmed(line);
  const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
  const std::string_view word = line.substr(0, end);
  const bool names = materials ? word.starts_with("map_") || word == "bump" || word == "disp" ||
                                     word == "decal" || word == "norm" || word == "refl"
                               : word == "mtllib";
  return names ? trimmed(line.substr(end)) : std::string_view();
}

class Companions {
 public:
  explicit Companions(const fs::path& obj)
      : folder_(fs::canonical(obj.parent_path().empty() ? "." : obj.parent_path())) {}

  void look_into(const fs::path& file, bool materials) {
    const std::string text = read_text(file, scene_limits::kLargestModel);
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      take(named_in(std::string_view(text).substr(at, end - at), materials), materials);
      at = end + 1;
    }
  }
  std::vector<fs::path> all() && { return std::move(all_); }

 private:
  // Takes a name with blanks; else the last word behind a picture's options, or each of several
  // names.
  void take(std::string_view words, bool pictures) {
    if (words.empty() || take_file(std::string(words), pictures)) return;
    while (!words.empty()) {
      const std::size_t blank = words.find_last_of(kBlanks);
      const std::size_t from = blank == words.npos ? 0 : blank + 1;
      take_file(std::string(words.substr(from)), pictures);
      words =
          pictures || blank == words.npos ? std::string_view() : trimmed(words.substr(0, blank));
    }
  }

  bool take_file(std::string name, bool pictures) {
    std::replace(name.begin(), name.end(), '\\', '/');
    const fs::path relative = fs::path(name).lexically_normal();
    std::error_code error;
    const fs::path file = fs::canonical(folder_ / relative, error);
    const fs::path inside = error ? fs::path() : file.lexically_relative(folder_);
    if (inside.empty() || *inside.begin() == ".." || relative.is_absolute() ||
        *relative.begin() == ".." || !fs::is_regular_file(file, error) ||
        ::access(file.c_str(), R_OK) != 0) {
      return false;
    }
    if (all_.size() >= kMostCompanions || std::ranges::find(all_, relative) != all_.end()) {
      return true;
    }
    all_.push_back(relative);
    if (!pictures) look_into(file, true);
    return true;
  }

  fs::path folder_;
  std::vector<fs::path> all_;
};

using Bytes = std::vector<unsigned char>;

Bytes read_bytes(const fs::path& file) {
  const std::string text = read_text(file, scene_limits::kLargestModel);
  return {text.begin(), text.end()};
}

bool consists_of(ModelFiles files, const fs::path& file) {
  const ModelKind* const kind = model_kind(file);
  return kind != nullptr && kind->files == files;
}

bool holds(const fs::path& file, const Bytes& bytes) {
  std::error_code none;
  return fs::is_regular_file(file, none) && fs::file_size(file, none) == bytes.size() &&
         read_bytes(file) == bytes;
}

bool is_there(const fs::path& file) {
  std::error_code none;
  return fs::exists(fs::symlink_status(file, none));
}

// The i-th of several different things called `name`.
std::string numbered(const std::string& name, int i) {
  return i == 1 ? name : fmt::format("{}-{}", name, i);
}

// Brings the models of a scene to where its file can name them.
class Models {
 public:
  explicit Models(fs::path folder) : folder_(std::move(folder)) {}
  ~Models() {
    std::error_code none;
    if (!kept_) {
      for (auto copy = copies_.rbegin(); copy != copies_.rend(); ++copy) fs::remove(*copy, none);
    }
  }
  Models(const Models&) = delete;
  Models& operator=(const Models&) = delete;

  // Returns the name for a model at `path`; for a model without a path, it has these bytes.
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
      if (consists_of(ModelFiles::many, path)) return path.string();
      if (consists_of(ModelFiles::named, path)) return copy_obj(path);
    }
    return bytes != nullptr ? copy(fs::path(name), *bytes) : copy(fs::path(name), read_bytes(path));
  }

  std::string copy(const fs::path& name, const Bytes& bytes) {
    for (int i = 1;; ++i) {
      const fs::path out =
          folder_ / (numbered(name.stem().string(), i) + name.extension().string());
      if (!is_there(out)) write(out, bytes);
      if (holds(out, bytes)) return out.filename().string();
    }
  }

  // Copies an OBJ model into a folder of its own: it names its companions, which have to keep their
  // names.
  std::string copy_obj(const fs::path& path) {
    std::vector<fs::path> files = obj_companions(path);
    if (files.empty()) return copy(path.filename(), read_bytes(path));
    files.push_back(path.filename());
    for (int i = 1;; ++i) {
      const fs::path name = numbered(path.stem().string(), i);
      const bool fresh = !is_there(folder_ / name);
      if (fresh) make_folder(folder_ / name);
      const bool same = std::ranges::all_of(files, [&](const fs::path& each) {
        const fs::path out = folder_ / name / each;
        const Bytes bytes = read_bytes(path.parent_path() / each);
        if (fresh) make_folder(out.parent_path());
        if (fresh && !is_there(out)) write(out, bytes);
        return holds(out, bytes);
      });
      if (same) return (name / path.filename()).string();
    }
  }

  void write(const fs::path& out, const Bytes& bytes) {
    write_atomically(out, bytes);
    copies_.push_back(out);
  }

  void make_folder(const fs::path& out) {
    if (is_there(out)) return;
    make_folder(out.parent_path());
    std::error_code error;
    if (!fs::create_directory(out, error)) {
      throw FileError(fmt::format("{}: cannot be made: {}", out.string(), error.message()));
    }
    copies_.push_back(out);
  }

  fs::path folder_;
  std::map<fs::path, std::string> names_;
  std::vector<fs::path> copies_;
  bool kept_ = false;
};

}  // namespace

std::vector<fs::path> obj_companions(const fs::path& obj) {
  Companions companions(obj);
  companions.look_into(obj, false);
  return std::move(companions).all();
}

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
  for (Object& object : out.scene.objects) {
    auto* const mesh = std::get_if<Mesh>(&object.shape);
    if (mesh == nullptr) continue;
    const ModelFile& model = document.models.at(mesh->model);
    mesh->model = models.place(model.path, mesh->model, model.bytes.get());
    out.models[mesh->model] = {(folder / mesh->model).lexically_normal().string(), model.bytes};
  }
  for (SceneVisual& visual : out.visuals) {
    const std::string name = models.place(visual.file, visual.file, nullptr);
    visual.file = (folder / name).lexically_normal().string();
  }
  out.toml = scene_text(out, arm, folder);
  // Refuses to replace a file with one that could not be read again.
  parse_scene(out.toml, file.string(), folder, arm, files_of(out));
  write_atomically(
      file, std::span(reinterpret_cast<const unsigned char*>(out.toml.data()), out.toml.size()));
  models.keep();
  return out;
}

}  // namespace limpid
