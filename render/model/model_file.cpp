#include "render/model/model_file.h"

#include <algorithm>
#include <stdexcept>

#include "core/base/model_kinds.h"
#include "core/base/utf8.h"
#include "render/model/companions.h"
#include "render/model/gltf_model.h"
#include "render/model/gltf_pack.h"
#include "render/model/model_building.h"
#include "render/model/model_program.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// Sets unit and axis, as far as the format knows any.
void take_conventions(std::span<const unsigned char> bytes, const ModelKind& kind, Model& model) {
  model.unit = 0;
  model.up = Model::Up::unsaid;
  if (kind.suffix != ".dae") return;
  const std::string text = utf8_of({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const auto at = text.find("<up_axis>");
  const std::string axis = at == text.npos ? "" : text.substr(at + 9, 8);
  model.unit = 1;
  model.up = axis.find('Z') != axis.npos ? Model::Up::z : Model::Up::y;
}

Model parse_other(std::span<const unsigned char> bytes, const ModelKind& kind,
                  const std::string& name, const fs::path& folder, const LoadProgress& progress,
                  std::vector<unsigned char>* whole) {
  ConvertedModel converted = convert_model(bytes, kind, name, folder, progress);
  Model model = parse_gltf(converted.glb, name, {}, {.cancel = progress.cancel});
  for (const std::string& warning : converted.warnings) add_warning(model, warning);
  take_conventions(bytes, kind, model);
  if (whole && converted.outside) *whole = std::move(converted.glb);
  if (progress.part) *progress.part = 1;
  return model;
}

}  // namespace

Model parse_model(std::span<const unsigned char> bytes, const std::string& name,
                  const fs::path& folder, const LoadProgress& progress,
                  std::vector<unsigned char>* whole) {
  constexpr std::string_view kMagic = "glTF";
  // A recording keeps models that had files beside them as binary glTF, whatever their names.
  const bool binary =
      bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
  const ModelKind* const kind = model_kind(name);
  if (bytes.size() > kLargestModelFiles)
    throw std::runtime_error(name + ": is larger than the limit of " +
                             std::to_string(kLargestModelFiles >> 20) + " MiB");
  if (binary || (kind != nullptr && kind->gltf)) {
    Model model = parse_gltf(bytes, name, folder, progress);
    if (whole) *whole = pack_gltf(bytes, name, folder);
    return model;
  }
  if (kind != nullptr) return parse_other(bytes, *kind, name, folder, progress, whole);
  throw std::runtime_error(name +
                           ": is not a model that can be read; allowed: " + model_suffixes());
}

Model load_model_file(const fs::path& path, const LoadProgress& progress) {
  const auto bytes = read_bytes(path, kLargestModelFiles);
  if (progress.part) *progress.part = 0.1;
  const auto folder = path.parent_path();
  return parse_model(bytes, path.string(), folder.empty() ? "." : folder, progress);
}

}  // namespace limpid
