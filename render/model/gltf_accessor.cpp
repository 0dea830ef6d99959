#include "render/model/gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "render/model/gltf_file.h"
#include "render/model/gltf_meshopt.h"

namespace limpid {
namespace {

constexpr std::size_t kMostElements = std::size_t{64} << 20;
constexpr std::size_t kMostOwnBytes = std::size_t{512} << 20;

std::size_t bytes_of(int component_type) {
  const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type));
  return size > 0 ? static_cast<std::size_t>(size) : 0;
}

template <class T>
T read(const unsigned char* p) {
  T value;
  std::memcpy(&value, p, sizeof value);
  return value;
}

// Integers stand for themselves, or normalised for -1 to 1.
template <class T>
float number(const unsigned char* p, bool normalized) {
  const auto value = static_cast<float>(read<T>(p));
  if (!normalized) return value;
  return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
}

}  // namespace

void GltfAccessor::refuse(const std::string& why) const {
  throw std::runtime_error(name_ + ": " + one_line(why));
}

std::span<const unsigned char> GltfAccessor::part(int buffer, std::size_t offset,
                                                  std::size_t length, int view) const {
  const auto& bytes = at(gltf_.buffers, buffer, "buffer").data;
  if (offset > bytes.size() || length > bytes.size() - offset)
    refuse("buffer view " + std::to_string(view) + " reaches outside of its buffer");
  return std::span(bytes).subspan(offset, length);
}

std::span<const unsigned char> GltfAccessor::view(int buffer_view) {
  const auto& view = at(gltf_.bufferViews, buffer_view, "buffer view");
  const tinygltf::Value* const packed = meshopt_extension(view);
  if (packed == nullptr) return part(view.buffer, view.byteOffset, view.byteLength, buffer_view);
  const auto [place, is_new] = views_.try_emplace(buffer_view);
  if (is_new) {
    const MeshoptSource from = meshopt_source(*packed);
    place->second =
        decode_meshopt(*packed, part(from.buffer, from.offset, from.length, buffer_view),
                       kMostOwnBytes - own_bytes_);
    if (place->second.empty())
      refuse("buffer view " + std::to_string(buffer_view) + " cannot be decompressed");
    take(place->second.size());
  }
  return place->second;
}

void GltfAccessor::take(std::size_t bytes) {
  if (bytes > kMostOwnBytes - own_bytes_)
    refuse("has more than 512 MiB in compressed, sparse or empty accessors");
  own_bytes_ += bytes;
}

GltfAccessor::Kind GltfAccessor::kind(int index) const {
  const auto& accessor = at(gltf_.accessors, index, "accessor");
  const int components = tinygltf::GetNumComponentsInType(static_cast<unsigned>(accessor.type));
  const bool known = components >= 1 && components <= 4 && bytes_of(accessor.componentType) > 0;
  const bool matrix = accessor.type == TINYGLTF_TYPE_MAT4 &&
                      accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
  if (!known && !matrix) refuse("accessor " + std::to_string(index) + " has an unknown type");
  return {components, accessor.componentType};
}

void GltfAccessor::replace(int index, std::vector<unsigned char> bytes, int component_type) {
  const auto [components, own_type] = kind(index);
  const int type = component_type == 0 ? own_type : component_type;
  const std::size_t packed = bytes_of(type) * static_cast<std::size_t>(components);
  if (bytes.size() < packed) refuse("accessor " + std::to_string(index) + " has no data");
  take(bytes.size());
  auto own = std::make_shared<const std::vector<unsigned char>>(std::move(bytes));
  replaced_[index] = {own->data(), own->size() / packed,
                      packed,      components,
                      type,        gltf_.accessors[static_cast<std::size_t>(index)].normalized,
                      own};
}

Elements GltfAccessor::elements(int index) {
  if (const auto found = replaced_.find(index); found != replaced_.end()) return found->second;
  const auto& accessor = at(gltf_.accessors, index, "accessor");
  const auto [components, type] = kind(index);
  const std::size_t packed = bytes_of(type) * static_cast<std::size_t>(components);
  if (accessor.count == 0 || accessor.count > kMostElements)
    refuse("accessor " + std::to_string(index) + " has " + std::to_string(accessor.count) +
           " elements, allowed are 1 to " + std::to_string(kMostElements));
  Elements e{nullptr, accessor.count, packed, components, type, accessor.normalized, nullptr};
  if (accessor.bufferView >= 0) {
    const auto bytes = view(accessor.bufferView);
    const auto stride = gltf_.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
    if (stride != 0) e.stride = stride;
    // Every number here comes from the file, so each sum is bounded before the next is formed.
    const bool inside = accessor.byteOffset <= bytes.size() && e.stride >= packed &&
                        e.stride <= 252 &&
                        accessor.byteOffset + (e.count - 1) * e.stride + packed <= bytes.size();
    if (!inside) refuse("accessor " + std::to_string(index) + " reaches outside of its buffer");
    e.first = bytes.data() + accessor.byteOffset;
  }
  // Where there is no data there are zeros, of which a sparse accessor lists the exceptions.
  if (accessor.sparse.isSparse || e.first == nullptr) fill_in(accessor, e);
  return e;
}

// A sparse accessor is a list of exceptions from another one, or from zero.
void GltfAccessor::fill_in(const tinygltf::Accessor& accessor, Elements& e) {
  const std::size_t packed = bytes_of(e.component_type) * static_cast<std::size_t>(e.components);
  take(e.count * packed);
  auto all = std::make_shared<std::vector<unsigned char>>(e.count * packed);
  if (e.first)
    for (std::size_t i = 0; i < e.count; ++i)
      std::memcpy(all->data() + i * packed, e.first + i * e.stride, packed);
  e.first = all->data();
  e.stride = packed;
  e.own = all;
  const auto& sparse = accessor.sparse;
  if (!sparse.isSparse) return;
  // tinygltf has had numbers of either sign for offsets: a negative one is beyond all buffers.
  const auto list = [&](int buffer_view, auto offset, std::size_t size) {
    const auto bytes = view(buffer_view);
    const auto from = static_cast<std::size_t>(offset);
    const bool inside = sparse.count >= 0 && from <= bytes.size() && size > 0 &&
                        static_cast<std::size_t>(sparse.count) <= (bytes.size() - from) / size;
    if (!inside) refuse("a sparse accessor reaches outside of its buffer");
    return bytes.data() + from;
  };
  const std::size_t index_size = bytes_of(sparse.indices.componentType);
  Elements indices;
  indices.first = list(sparse.indices.bufferView, sparse.indices.byteOffset, index_size);
  indices.stride = index_size;
  indices.component_type = sparse.indices.componentType;
  const unsigned char* values = list(sparse.values.bufferView, sparse.values.byteOffset, packed);

  for (std::size_t i = 0; i < static_cast<std::size_t>(sparse.count); ++i) {
    const std::size_t to = index(indices, i);
    if (to >= e.count) refuse("a sparse accessor changes an element that does not exist");
    std::memcpy(all->data() + to * packed, values + i * packed, packed);
  }
}

Eigen::Vector4f GltfAccessor::element(const Elements& e, std::size_t i) const {
  const unsigned char* p = e.first + i * e.stride;
  Eigen::Vector4f out(0, 0, 0, 1);
  for (int c = 0; c < std::min(e.components, 4); ++c) {
    switch (e.component_type) {
      case TINYGLTF_COMPONENT_TYPE_FLOAT: out[c] = read<float>(p + 4 * c); break;
      case TINYGLTF_COMPONENT_TYPE_BYTE: out[c] = number<std::int8_t>(p + c, e.normalized); break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        out[c] = number<std::uint8_t>(p + c, e.normalized);
        break;
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        out[c] = number<std::int16_t>(p + 2 * c, e.normalized);
        break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        out[c] = number<std::uint16_t>(p + 2 * c, e.normalized);
        break;
      default: refuse("vertex data must be float, or integers of one or two bytes");
    }
  }
  if (!out.allFinite()) refuse("vertex data contains a number that is not finite");
  return out;
}

Eigen::Matrix4f GltfAccessor::matrix(const Elements& e, std::size_t i) const {
  if (e.components != 16) refuse("a list of matrices has something else in it");
  Eigen::Matrix4f out;
  std::memcpy(out.data(), e.first + i * e.stride, sizeof(float) * 16);
  return out;
}

std::uint32_t GltfAccessor::index(const Elements& e, std::size_t i) const {
  const unsigned char* p = e.first + i * e.stride;
  switch (e.component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return *p;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return read<std::uint16_t>(p);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return read<std::uint32_t>(p);
    default: refuse("indices must be unsigned integers");
  }
}

}  // namespace limpid
