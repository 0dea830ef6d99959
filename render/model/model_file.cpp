#include "render/model/model_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>

#include "render/model/assimp_model.h"
#include "render/model/companions.h"
#include "render/model/gltf_model.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr std::array kGltf{"glb", "gltf"};
constexpr std::array kOthers{"stl", "obj", "ply", "dae"};

// The suffix in small letters, without its dot.
std::string kind_of(const fs::path& file) {
  std::string suffix = file.extension().string();
  if (!suffix.empty()) suffix.erase(0, 1);
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix;
}

template <class List>
bool has(const List& list, const std::string& kind) {
  return std::find(list.begin(), list.end(), kind) != list.end();
}

}  // namespace

bool is_model_file(const fs::path& file) {
  const std::string kind = kind_of(file);
  return has(kGltf, kind) || has(kOthers, kind);
}

Model parse_model(std::span<const unsigned char> bytes, const std::string& name,
                  const fs::path& folder, const LoadProgress& progress) {
  constexpr std::string_view kMagic = "glTF";
  // In a recording any model that had files beside it is one of these.
  const bool binary =
      bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
  const std::string kind = kind_of(name);
  if (binary || has(kGltf, kind)) return parse_gltf(bytes, name, folder, progress);
  if (!has(kOthers, kind))
    throw std::runtime_error(name + ": is no model that can be read; allowed are " +
                             kModelSuffixes);
  if (bytes.size() > kLargestModelFiles)
    throw std::runtime_error(name + ": is larger than the " +
                             std::to_string(kLargestModelFiles >> 20) + " MiB that are read");
  return parse_with_assimp(bytes, kind, name, folder, progress);
}

Model load_model_file(const fs::path& path, const LoadProgress& progress) {
  const auto bytes = read_bytes(path, kLargestModelFiles);
  if (progress.part) *progress.part = 0.1;
  const auto folder = path.parent_path();
  return parse_model(bytes, path.string(), folder.empty() ? "." : folder, progress);
}

}  // namespace limpid
