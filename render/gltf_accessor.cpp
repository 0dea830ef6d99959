#include "render/gltf_accessor.h"

#include <cstring>

namespace limpid {
namespace {

constexpr std::size_t kMostElements = std::size_t{64} << 20;

}  // namespace

Elements GltfAccessor::elements(int accessor_index) const {
  const auto& accessor = at(gltf_.accessors, accessor_index, "accessor");
  if (accessor.sparse.isSparse) refuse("sparse accessors are not supported");
  const auto& view = at(gltf_.bufferViews, accessor.bufferView, "buffer view");
  const auto& buffer = at(gltf_.buffers, view.buffer, "buffer");
  const int size = tinygltf::GetComponentSizeInBytes(static_cast<unsigned>(accessor.componentType));
  const int components = tinygltf::GetNumComponentsInType(static_cast<unsigned>(accessor.type));
  if (size <= 0 || components <= 0 || components > 4) refuse("an accessor has an unknown type");
  const std::size_t packed = static_cast<std::size_t>(size * components);
  const std::size_t stride = view.byteStride == 0 ? packed : view.byteStride;
  const std::size_t total = buffer.data.size();
  // Every number below comes from the file, so each sum is bounded before the next is formed.
  const bool inside =
      view.byteOffset <= total && view.byteLength <= total - view.byteOffset &&
      accessor.byteOffset <= view.byteLength && stride >= packed && stride <= 252 &&
      accessor.count > 0 && accessor.count <= kMostElements &&
      accessor.byteOffset + (accessor.count - 1) * stride + packed <= view.byteLength;
  if (!inside)
    refuse("accessor " + std::to_string(accessor_index) + " reaches outside of its buffer");
  return {buffer.data.data() + view.byteOffset + accessor.byteOffset,
          accessor.count,
          stride,
          components,
          accessor.componentType,
          accessor.normalized};
}

Eigen::Vector4f GltfAccessor::element(const Elements& e, std::size_t i) const {
  const unsigned char* p = e.first + i * e.stride;
  Eigen::Vector4f out(0, 0, 0, 1);
  for (int c = 0; c < e.components; ++c) {
    switch (e.component_type) {
      case TINYGLTF_COMPONENT_TYPE_FLOAT: {
        float f;
        std::memcpy(&f, p + 4 * c, 4);
        out[c] = f;
        break;
      }
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: out[c] = static_cast<float>(p[c]) / 255.0f; break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
        std::uint16_t u;
        std::memcpy(&u, p + 2 * c, 2);
        out[c] = static_cast<float>(u) / 65535.0f;
        break;
      }
      default: refuse("vertex data must be float, unsigned byte or unsigned short");
    }
  }
  if (!out.allFinite()) refuse("vertex data contains a number that is not finite");
  return out;
}

std::uint32_t GltfAccessor::index(const Elements& e, std::size_t i) const {
  const unsigned char* p = e.first + i * e.stride;
  if (e.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return *p;
  if (e.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) {
    std::uint16_t u;
    std::memcpy(&u, p, 2);
    return u;
  }
  if (e.component_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    refuse("indices must be unsigned integers");
  std::uint32_t u;
  std::memcpy(&u, p, 4);
  return u;
}

}  // namespace limpid
