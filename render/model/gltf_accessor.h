// Numbers out of a glTF file's buffers, with every reference and every range checked.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/math/sizes.h"
#include "render/model/model.h"

namespace limpid {

// Typed elements of an accessor in memory, after all checks.
struct Elements {
  const unsigned char* first = nullptr;
  std::size_t count = 0, stride = 0;
  int components = 0, component_type = 0;
  bool normalized = false;
  std::shared_ptr<const std::vector<unsigned char>>
      own;  // keeps elements that no buffer holds as they are
};

class GltfAccessor {
 public:
  // Keeps references to both; they must outlive this. `name` stands for the file in messages.
  GltfAccessor(const tinygltf::Model& gltf, const std::string& name) : gltf_(gltf), name_(name) {}

  // Functions below throw std::runtime_error naming the file for what does not exist or fit.
  Elements elements(int accessor);
  std::span<const unsigned char> view(int buffer_view);
  Eigen::Vector4f element(const Elements& e, std::size_t i) const;  // missing parts: 0 0 0 1
  std::uint32_t index(const Elements& e, std::size_t i) const;

  Eigen::Matrix4f matrix(const Elements& e, std::size_t i) const;  // of an accessor of MAT4

  struct Kind {
    int components = 0, component_type = 0;
  };
  Kind kind(int accessor) const;
  // Replaces the elements of the accessor, packed; component_type 0 is the file's own.
  void replace(int accessor, std::vector<unsigned char> bytes, int component_type = 0);

  template <class List>
  const auto& at(const List& list, int index, const char* what) const {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size())
      refuse(std::string(what) + " " + std::to_string(index) + " does not exist, the file has " +
             std::to_string(list.size()));
    return list[static_cast<std::size_t>(index)];
  }
  [[noreturn]] void refuse(const std::string& why) const;

 private:
  std::span<const unsigned char> part(int buffer, std::size_t offset, std::size_t length,
                                      int view) const;
  void fill_in(const tinygltf::Accessor& accessor, Elements& e);
  void take(std::size_t bytes);  // counts memory for what no buffer holds as it is

  const tinygltf::Model& gltf_;
  const std::string& name_;
  std::size_t own_bytes_ = 0;                        // taken so far
  std::map<int, std::vector<unsigned char>> views_;  // decompressed
  std::map<int, Elements> replaced_;                 // accessors
};

// Returns what a compressed view says about itself (EXT_ or KHR_meshopt_compression); null: it is
// not compressed.
const tinygltf::Value* meshopt_extension(const tinygltf::BufferView& view);

// Place of the compressed bytes.
struct MeshoptSource {
  int buffer = 0;
  std::size_t offset = 0, length = 0;
};
MeshoptSource meshopt_source(const tinygltf::Value& extension);

// Decompresses the bytes of a view; empty for what cannot be decoded or has more than `most` bytes.
std::vector<unsigned char> decode_meshopt(const tinygltf::Value& extension,
                                          std::span<const unsigned char> bytes, std::size_t most);

// A glTF primitive as plain triangles over the vertices it uses.
struct Triangles {
  std::vector<std::uint32_t> corners;  // three a triangle, strips and fans taken apart
  std::size_t looked_at = 0;
};

// Leaves out triangles that name a vertex twice. Throws std::runtime_error naming the file when
// there are more than `most` to look at.
Triangles read_triangles(GltfAccessor& file, const tinygltf::Primitive& primitive,
                         std::size_t vertices, std::size_t most);

// Vertices that one primitive uses, where several share one long list.
class VertexUse {
 public:
  // Lists which of `count` vertices are used, in order of use; `corners` become places in that
  // list.
  const std::vector<std::uint32_t>& renumber(std::vector<std::uint32_t>& corners,
                                             std::size_t count);

 private:
  std::vector<std::uint32_t> place_, used_;
};

// Transforms of nodes in the scene, by their numbers.
using NodePoses = std::vector<Eigen::Affine3d>;

// Vertices at rest: morphed by the default weights, and held by the joints of a skin as the nodes
// stand. Errors: std::runtime_error naming the file.
class GltfRest {
 public:
  GltfRest(const tinygltf::Model& gltf, GltfAccessor& file, const NodePoses& nodes)
      : gltf_(gltf), file_(file), nodes_(nodes) {}

  // Returns what morphing adds to one attribute (POSITION, NORMAL) of each vertex in `used`; empty:
  // nothing.
  std::vector<Eigen::Vector3f> shifts(const tinygltf::Node& node,
                                      const tinygltf::Primitive& primitive, const char* attribute,
                                      const std::vector<std::uint32_t>& used, std::size_t count);
  // Returns the transform of each vertex in `used` into the scene; empty: that of the node.
  std::vector<Eigen::Affine3f> moves(const tinygltf::Node& node,
                                     const tinygltf::Primitive& primitive,
                                     const std::vector<std::uint32_t>& used, std::size_t count);

 private:
  std::vector<Eigen::Affine3f> joints(const tinygltf::Skin& skin);

  const tinygltf::Model& gltf_;
  GltfAccessor& file_;
  const NodePoses& nodes_;
};

// Returns the accessor of an attribute, -1 for none.
int attribute_of(const std::map<std::string, int>& attributes, const std::string& key);

}  // namespace limpid
