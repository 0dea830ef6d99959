// The kinds of model files that are read, and what is usual in each. Another kind is a line here,
// and what reads it in render/model, unless assimp reads it as it is.
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace limpid {

// What else a model may consist of.
enum class ModelFiles : std::uint8_t {
  one,    // nothing
  named,  // files that it names as OBJ does: they are few, and can be copied with it
  many,   // files in folders of their own, as a rule: it stays where it is
};

struct ModelKind {
  std::string_view suffix;  // in small letters
  bool gltf;                // else limpid-model reads it
  ModelFiles files;
  double unit;     // of its coordinates, where neither it nor a scene says so [m]
  bool y_up;       // likewise; else z is up
  bool materials;  // it has some; else what assimp calls one is its own invention
  bool normals;    // its normals say how a surface is meant to look, not how a facet lies
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

// Null for a file of another kind.
inline const ModelKind* model_kind(const std::filesystem::path& file) {
  const std::string suffix = small_suffix(file);
  const auto* const found = std::ranges::find(kModelKinds, suffix, &ModelKind::suffix);
  return found == kModelKinds.end() ? nullptr : found;
}

// For people: ".glb, .gltf, ...".
inline std::string model_suffixes() {
  std::string all;
  for (const ModelKind& each : kModelKinds) {
    if (!all.empty()) all += ", ";
    all += each.suffix;
  }
  return all;
}

}  // namespace limpid
