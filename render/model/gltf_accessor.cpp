#include "render/model/gltf_accessor.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include "render/model/gltf_file.h"

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

// Reads an integer as itself, or normalised to -1 to 1.
template <class T>
float number(const unsigned char* p, bool normalized) {
  const auto value = static_cast<float>(read<T>(p));
  if (!normalized) return value;
  return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
}

// Reads a number, neither below zero nor beyond what a file can hold.
std::size_t number(const tinygltf::Value& object, const char* key) {
  const auto& value = object.Get(key);
  const double read = value.IsNumber() ? value.GetNumberAsDouble() : 0;
  return read >= 0 && read < 4e9 ? static_cast<std::size_t>(read) : 0;
}

std::string word(const tinygltf::Value& object, const char* key) {
  const auto& value = object.Get(key);
  return value.IsString() ? value.Get<std::string>() : "";
}

// Undoes a filter that made the numbers compress better; false: it is unknown, or does not fit.
bool undo_filter(const std::string& filter, std::vector<unsigned char>& out, std::size_t count,
                 std::size_t stride) {
  if (filter.empty() || filter == "NONE") return true;
  if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) {
    meshopt_decodeFilterOct(out.data(), count, stride);
  } else if (filter == "QUATERNION" && stride == 8) {
    meshopt_decodeFilterQuat(out.data(), count, stride);
  } else if (filter == "EXPONENTIAL" && stride % 4 == 0) {
    meshopt_decodeFilterExp(out.data(), count, stride);
  } else {
    return false;
  }
  return true;
}

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

}  // namespace

void GltfAccessor::refuse(const std::string& why) const {
  throw std::runtime_error(name_ + ": " + one_line(why));
}

std::span<const unsigned char> GltfAccessor::part(int buffer, std::size_t offset,
                                                  std::size_t length, int view) const {
  const auto& bytes = at(gltf_.buffers, buffer, "buffer").data;
  if (offset > bytes.size() || length > bytes.size() - offset)
    refuse("buffer view " + std::to_string(view) + " extends outside its buffer");
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
    if (!inside) refuse("accessor " + std::to_string(index) + " extends outside its buffer");
    e.first = bytes.data() + accessor.byteOffset;
  }
  // Elements without data are zeros; a sparse accessor lists the exceptions.
  if (accessor.sparse.isSparse || e.first == nullptr) fill_in(accessor, e);
  return e;
}

// Fills in a sparse accessor: a list of exceptions from another one, or from zero.
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
  // Some versions of tinygltf have signed offsets: a negative one is beyond all buffers.
  const auto list = [&](int buffer_view, auto offset, std::size_t size) {
    const auto bytes = view(buffer_view);
    const auto from = static_cast<std::size_t>(offset);
    const bool inside = sparse.count >= 0 && from <= bytes.size() && size > 0 &&
                        static_cast<std::size_t>(sparse.count) <= (bytes.size() - from) / size;
    if (!inside) refuse("a sparse accessor extends outside its buffer");
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
  if (e.components != 16) refuse("a list of matrices has an element that is not a matrix");
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

const tinygltf::Value* meshopt_extension(const tinygltf::BufferView& view) {
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const auto found = view.extensions.find(name);
    if (found != view.extensions.end() && found->second.IsObject()) return &found->second;
  }
  return nullptr;
}

MeshoptSource meshopt_source(const tinygltf::Value& extension) {
  return {static_cast<int>(number(extension, "buffer") & 0x7FFFFFFF),
          number(extension, "byteOffset"), number(extension, "byteLength")};
}

std::vector<unsigned char> decode_meshopt(const tinygltf::Value& extension,
                                          std::span<const unsigned char> bytes, std::size_t most) {
  const std::size_t count = number(extension, "count"), stride = number(extension, "byteStride");
  const std::string mode = word(extension, "mode");
  if (count == 0 || stride == 0 || stride > 256 || count > most / stride) return {};
  std::vector<unsigned char> out(count * stride);
  int failed = 1;
  // The library takes these conditions for granted.
  if (mode == "ATTRIBUTES" && stride % 4 == 0) {
    failed = meshopt_decodeVertexBuffer(out.data(), count, stride, bytes.data(), bytes.size());
    if (failed == 0 && !undo_filter(word(extension, "filter"), out, count, stride)) failed = 1;
  } else if (mode == "TRIANGLES" && count % 3 == 0 && (stride == 2 || stride == 4)) {
    failed = meshopt_decodeIndexBuffer(out.data(), count, stride, bytes.data(), bytes.size());
  } else if (mode == "INDICES" && (stride == 2 || stride == 4)) {
    failed = meshopt_decodeIndexSequence(out.data(), count, stride, bytes.data(), bytes.size());
  }
  if (failed != 0) out.clear();
  return out;
}

Triangles read_triangles(GltfAccessor& file, const tinygltf::Primitive& primitive,
                         std::size_t vertices, std::size_t most) {
  Elements e;
  std::size_t count = vertices;
  if (primitive.indices >= 0) {
    e = file.elements(primitive.indices);
    if (e.components != 1) file.refuse("indices must be single numbers");
    count = e.count;
  }
  const auto vertex = [&](std::size_t i) {
    const std::uint32_t k =
        primitive.indices >= 0 ? file.index(e, i) : static_cast<std::uint32_t>(i);
    if (k >= vertices)
      file.refuse("index " + std::to_string(k) + " is outside the mesh's " +
                  std::to_string(vertices) + " vertices");
    return k;
  };
  const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
  const bool fan = primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
  if (!list && !fan && primitive.mode != TINYGLTF_MODE_TRIANGLE_STRIP)
    file.refuse("a mesh is drawn in the unknown mode " + std::to_string(primitive.mode));
  if (list && count % 3 != 0) file.refuse("the number of indices is not a multiple of 3");
  const std::size_t made = list ? count / 3 : count < 3 ? 0 : count - 2;
  if (made > most) file.refuse("has more than 6 million triangles in all nodes together");
  Triangles out{{}, made};
  out.corners.reserve(3 * made);
  for (std::size_t i = 0; i < made; ++i) {
    // Every second triangle of a strip is turned over.
    const std::size_t odd = i % 2;
    const std::uint32_t a = vertex(list ? 3 * i : fan ? 0 : i);
    const std::uint32_t b = vertex(list ? 3 * i + 1 : fan ? i + 1 : i + 1 + odd);
    const std::uint32_t c = vertex(list ? 3 * i + 2 : fan ? i + 2 : i + 2 - odd);
    if (a != b && b != c && c != a) out.corners.insert(out.corners.end(), {a, b, c});
  }
  return out;
}

const std::vector<std::uint32_t>& VertexUse::renumber(std::vector<std::uint32_t>& corners,
                                                      std::size_t count) {
  if (place_.size() < count) place_.resize(count, kUnused);
  used_.clear();
  for (std::uint32_t& corner : corners) {
    std::uint32_t& place = place_[corner];
    if (place == kUnused) {
      place = static_cast<std::uint32_t>(used_.size());
      used_.push_back(corner);
    }
    corner = place;
  }
  for (const std::uint32_t vertex : used_) place_[vertex] = kUnused;
  return used_;
}

int attribute_of(const std::map<std::string, int>& attributes, const std::string& key) {
  const auto found = attributes.find(key);
  return found == attributes.end() ? -1 : found->second;
}

std::vector<Eigen::Vector3f> GltfRest::shifts(const tinygltf::Node& node,
                                              const tinygltf::Primitive& primitive,
                                              const char* attribute,
                                              const std::vector<std::uint32_t>& used,
                                              std::size_t count) {
  const auto& mesh = file_.at(gltf_.meshes, node.mesh, "mesh");
  const std::vector<double>& weights = node.weights.empty() ? mesh.weights : node.weights;
  std::vector<Eigen::Vector3f> sum;
  for (std::size_t k = 0; k < std::min(weights.size(), primitive.targets.size()); ++k) {
    const int accessor = attribute_of(primitive.targets[k], attribute);
    if (accessor < 0 || weights[k] == 0 || !std::isfinite(weights[k])) continue;
    const Elements e = file_.elements(accessor);
    if (e.count != count || e.components < 3)
      file_.refuse(std::string("a morph target's ") + attribute + " does not match its mesh");
    sum.resize(used.size(), Eigen::Vector3f::Zero());
    for (std::size_t i = 0; i < used.size(); ++i)
      sum[i] += static_cast<float>(weights[k]) * file_.element(e, used[i]).head<3>();
  }
  return sum;
}

std::vector<Eigen::Affine3f> GltfRest::joints(const tinygltf::Skin& skin) {
  std::vector<Eigen::Affine3f> out;
  Elements inverse;
  if (skin.inverseBindMatrices >= 0) inverse = file_.elements(skin.inverseBindMatrices);
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    Eigen::Affine3d move = file_.at(nodes_, skin.joints[i], "node");
    if (i < inverse.count) {
      Eigen::Affine3d bind(file_.matrix(inverse, i).cast<double>());
      bind.makeAffine();
      move = move * bind;
    }
    out.emplace_back(move.cast<float>());
    if (!out.back().matrix().allFinite())
      file_.refuse("has a skin with a number that is not finite");
  }
  return out;
}

std::vector<Eigen::Affine3f> GltfRest::moves(const tinygltf::Node& node,
                                             const tinygltf::Primitive& primitive,
                                             const std::vector<std::uint32_t>& used,
                                             std::size_t count) {
  const int which = attribute_of(primitive.attributes, "JOINTS_0");
  const int how_much = attribute_of(primitive.attributes, "WEIGHTS_0");
  if (node.skin < 0 || which < 0 || how_much < 0) return {};
  const auto each = joints(file_.at(gltf_.skins, node.skin, "skin"));
  const Elements joint = file_.elements(which), weight = file_.elements(how_much);
  if (joint.count != count || weight.count != count || joint.components != 4 ||
      weight.components != 4)
    file_.refuse("JOINTS_0 and WEIGHTS_0 do not match POSITION");
  std::vector<Eigen::Affine3f> out;
  out.reserve(used.size());
  for (const std::uint32_t i : used) {
    const Eigen::Vector4f at = file_.element(joint, i), w = file_.element(weight, i);
    Eigen::Matrix4f sum = Eigen::Matrix4f::Zero();
    for (int k = 0; k < 4; ++k)
      if (w[k] != 0) sum += w[k] * file_.at(each, static_cast<int>(at[k]), "joint").matrix();
    // Weights add up to one, but for those that were rounded.
    const float all = w.sum();
    out.emplace_back(all > 1e-6f ? Eigen::Matrix4f(sum / all) : Eigen::Matrix4f::Identity());
  }
  return out;
}

}  // namespace limpid
