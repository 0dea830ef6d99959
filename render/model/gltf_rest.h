// Where vertices are while nothing moves: morphed by the default weights, and held by the joints of
// a skin as the nodes stand.
#pragma once

#include <vector>

#include "render/model/gltf_accessor.h"

namespace limpid {

// Nodes' transforms in the scene, by their numbers.
using NodePoses = std::vector<Eigen::Affine3d>;

class GltfRest {
 public:
  GltfRest(const tinygltf::Model& gltf, GltfAccessor& file, const NodePoses& nodes)
      : gltf_(gltf), file_(file), nodes_(nodes) {}

  // Of the `used` vertices of a primitive: what is added to one attribute (POSITION, NORMAL).
  // Empty: nothing. All of these throw std::runtime_error naming the file.
  std::vector<Eigen::Vector3f> shifts(const tinygltf::Node& node,
                                      const tinygltf::Primitive& primitive, const char* attribute,
                                      const std::vector<std::uint32_t>& used, std::size_t count);
  // ... and the transform of each into the scene. Empty: that of the node.
  std::vector<Eigen::Affine3f> moves(const tinygltf::Node& node,
                                     const tinygltf::Primitive& primitive,
                                     const std::vector<std::uint32_t>& used, std::size_t count);

 private:
  std::vector<Eigen::Affine3f> joints(const tinygltf::Skin& skin);

  const tinygltf::Model& gltf_;
  GltfAccessor& file_;
  const NodePoses& nodes_;
};

// The accessor of an attribute, -1 for none.
int attribute_of(const std::map<std::string, int>& attributes, const std::string& key);

}  // namespace limpid
