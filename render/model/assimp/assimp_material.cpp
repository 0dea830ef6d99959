#include "render/model/assimp/assimp_material.h"

#include <assimp/scene.h>

#include <algorithm>
#include <cmath>

#include "render/model/model_building.h"

namespace limpid {

const AssimpMaterial& AssimpMaterials::at(unsigned index) {
  const auto found = known_.find(index);
  if (found != known_.end()) return found->second;
  // STL and PLY have colours at most; what assimp gives them is its own invention.
  const bool has_materials = kind_ == "obj" || kind_ == "dae";
  AssimpMaterial made;
  if (has_materials && index < scene_.mNumMaterials) made = read(*scene_.mMaterials[index]);
  return known_.emplace(index, made).first->second;
}

AssimpMaterial AssimpMaterials::read(const aiMaterial& from) {
  AssimpMaterial to;
  aiString text;
  if (from.Get(AI_MATKEY_NAME, text) == aiReturn_SUCCESS &&
      text == aiString(AI_DEFAULT_MATERIAL_NAME))
    return to;
  aiString file;
  if (from.GetTexture(aiTextureType_DIFFUSE, 0, &file) == aiReturn_SUCCESS && file.length > 0) {
    to.finish.color = picture(file.C_Str());
    to.plain = to.finish.color < 0;
    if (!to.plain) to.color.setOnes();
  }
  aiColor4D diffuse;
  // Beside a picture black is what many exporters write for nothing.
  if (from.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse) == aiReturn_SUCCESS &&
      (to.plain || !diffuse.IsBlack())) {
    to.color = linear({diffuse.r, diffuse.g, diffuse.b});
    to.plain = false;
  }
  float opacity = 1;
  from.Get(AI_MATKEY_OPACITY, opacity);
  // Exporters disagree on which end of the scale is opaque; what nobody could see is not meant.
  if (opacity > 0.02f && opacity < 1) {
    to.opacity = opacity;
    to.finish.alpha = Finish::Alpha::blend;
  }
  to.finish.two_sided = true;  // these formats do not say which side is seen
  return to;
}

int AssimpMaterials::picture(const std::string& file) {
  const auto [place, is_new] = numbers_.try_emplace(file, -1);
  if (!is_new) return place->second;
  auto bytes = files_.read(file);
  if (bytes.empty()) return -1;
  pictures_.push_back(std::move(bytes));
  return place->second = static_cast<int>(pictures_.size()) - 1;
}

}  // namespace limpid
