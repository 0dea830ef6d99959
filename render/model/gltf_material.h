// Materials of a glTF file, with the pictures they use.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "render/model/gltf_accessor.h"
#include "render/model/gltf_file.h"
#include "render/model/model.h"

namespace limpid {

// End of a warning about a picture that decode() cannot read.
inline constexpr const char* kUnknownPicture =
    "not a PNG, JPEG or WebP that can be read, so it is ignored";

// Decodes the pictures of a model: PNG, JPEG and WebP, within limits of size and work.
class ModelImages {
 public:
  // Returns nothing for what is no readable PNG, JPEG or WebP. Throws std::runtime_error naming the
  // file when all pictures so far come to more than 1 GiB, encoded or decoded.
  std::optional<Image> decode(std::span<const unsigned char> bytes, const std::string& name);

 private:
  std::size_t encoded_ = 0, decoded_ = 0;  // bytes so far
};

// A material as the vertices and the part of a model take it.
struct GltfMaterial {
  Finish material;
  Eigen::Vector3f color = Vertex{}.color;  // linear
  float opacity = 1;
  Eigen::Vector2f surface = Vertex{}.surface;  // metallic, roughness
  int uv_set = 0;
  Eigen::Affine2f uv_move = Eigen::Affine2f::Identity();
};

class GltfMaterials {
 public:
  // Adds pictures to model.images, warnings about what is left out to model.warnings.
  GltfMaterials(const GltfFile& source, GltfAccessor& file, const std::string& name, Model& model)
      : source_(source), file_(file), name_(name), model_(model) {}

  // Returns a material, decoding its pictures when it is new. -1: none, plain grey.
  const GltfMaterial& at(int index);

 private:
  GltfMaterial read(const tinygltf::Material& from);
  template <class Info>
  int texture(const Info& info, bool srgb, GltfMaterial& to, bool& placed);
  int picture(int source, bool srgb, Image::Wrap wrap_u, Image::Wrap wrap_v);
  void warn(const std::string& what);

  const GltfFile& source_;
  GltfAccessor& file_;
  const std::string& name_;
  Model& model_;
  ModelImages images_;
  std::map<int, GltfMaterial> known_;
  std::map<std::tuple<int, bool, Image::Wrap, Image::Wrap>, int> pictures_;
};

}  // namespace limpid
