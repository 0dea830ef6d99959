// The kinds of model files that can be read, and what is usual in each. A further kind is a line
// here and a reader in render/model, unless assimp reads it as it is.
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace limpid {

// Further files that a model may consist of.
enum class ModelFiles : std::uint8_t {
  one,    // none
  named,  // those that it names as OBJ does: few, and copied with it
  many,   // those in folders of their own, as a rule: the model stays where it is
};

struct ModelKind {
  std::string_view suffix;  // in small letters
  bool gltf;                // else limpid-model reads the file
  ModelFiles files;
  double unit;     // of coordinates, unless the file or a scene names another [m]
  bool y_up;       // likewise; else z is up
  bool materials;  // the kind has materials; else assimp's are its own invention
  bool normals;    // normals give the shape meant, not a facet's plane
};

// Programs that write STL think in millimetres.
inline constexpr std::array kModelKinds{
    ModelKind{".glb", true, ModelFiles::one, 1, false, true, true},
    ModelKind{".gltf", true, ModelFiles::many, 1, false, true, true},
    ModelKind{".stl", false, ModelFiles::one, 0.001, false, false, false},
    ModelKind{".obj", false, ModelFiles::named, 1, true, true, true},
    ModelKind{".ply", false, ModelFiles::one, 1, false, false, true},
    ModelKind{".dae", false, ModelFiles::many, 1, false, true, true},
};

// The suffix of a file in small letters, with its dot.
inline std::string small_suffix(const std::filesystem::path& file) {
  std::string suffix = file.extension().string();
  for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return suffix;
}

// Returns the kind of `file` by its suffix; null: unknown.
inline const ModelKind* model_kind(const std::filesystem::path& file) {
  const std::string suffix = small_suffix(file);
  const auto* const found = std::ranges::find(kModelKinds, suffix, &ModelKind::suffix);
  return found == kModelKinds.end() ? nullptr : found;
}

// All suffixes as a text for people: ".glb, .gltf, ...".
inline std::string model_suffixes() {
  std::string all;
  for (const ModelKind& each : kModelKinds) {
    if (!all.empty()) all += ", ";
    all += each.suffix;
  }
  return all;
}

}  // namespace limpid
