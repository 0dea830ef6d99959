#include "render/model/gltf_draco.h"

#include <draco/compression/decode.h>

#include <cstring>
#include <exception>

namespace limpid {
namespace {

std::unique_ptr<draco::Mesh> decode(std::span<const unsigned char> bytes) {
  try {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    return decoded.ok() ? std::move(decoded).value() : nullptr;
  } catch (const std::exception&) {  // memory for what it says that it has
    return nullptr;
  }
}

// Returns the numbers of one attribute, as the accessor that they stand for has them.
template <class T>
std::vector<unsigned char> values(const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                                  int components) {
  std::vector<unsigned char> out(mesh.num_points() * sizeof(T) *
                                 static_cast<std::size_t>(components));
  std::array<T, 4> value{};
  for (draco::PointIndex i(0); i < mesh.num_points(); ++i) {
    attribute.ConvertValue(attribute.mapped_index(i), static_cast<std::int8_t>(components),
                           value.data());
    const std::size_t size = sizeof(T) * static_cast<std::size_t>(components);
    std::memcpy(out.data() + i.value() * size, value.data(), size);
  }
  return out;
}

std::vector<unsigned char> values(const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                                  int components, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return values<std::int8_t>(mesh, attribute, components);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return values<std::uint8_t>(mesh, attribute, components);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return values<std::int16_t>(mesh, attribute, components);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return values<std::uint16_t>(mesh, attribute, components);
    default: return values<float>(mesh, attribute, components);
  }
}

std::vector<unsigned char> corners(const draco::Mesh& mesh) {
  std::vector<unsigned char> out(std::size_t{mesh.num_faces()} * 3 * sizeof(std::uint32_t));
  for (draco::FaceIndex i(0); i < mesh.num_faces(); ++i) {
    const auto& face = mesh.face(i);
    const std::array<std::uint32_t, 3> at{face[0].value(), face[1].value(), face[2].value()};
    std::memcpy(out.data() + i.value() * sizeof at, at.data(), sizeof at);
  }
  return out;
}

}  // namespace

void decode_draco(const tinygltf::Primitive& primitive, GltfAccessor& file, std::size_t most) {
  const auto found = primitive.extensions.find(kDracoExtension);
  if (found == primitive.extensions.end() || !found->second.IsObject()) return;
  const auto& view = found->second.Get("bufferView");
  const auto& attributes = found->second.Get("attributes");
  if (!view.IsInt() || !attributes.IsObject()) file.refuse("has Draco data that is incomplete");
  const auto mesh = decode(file.view(view.GetNumberAsInt()));
  if (!mesh) file.refuse("has Draco data that cannot be decoded");
  if (mesh->num_faces() > most)
    file.refuse("has more than 6 million triangles in all nodes together");
  for (const std::string& key : attributes.Keys()) {
    const auto at = primitive.attributes.find(key);
    const auto& id = attributes.Get(key);
    if (at == primitive.attributes.end() || !id.IsInt()) continue;
    const auto* attribute =
        mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id.GetNumberAsInt()));
    if (attribute == nullptr) file.refuse("has Draco data without its " + key);
    const GltfAccessor::Kind kind = file.kind(at->second);
    file.replace(at->second, values(*mesh, *attribute, kind.components, kind.component_type));
  }
  if (primitive.indices >= 0)
    file.replace(primitive.indices, corners(*mesh), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
}

}  // namespace limpid
