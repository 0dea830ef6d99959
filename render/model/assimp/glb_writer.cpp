#include "render/model/assimp/glb_writer.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "render/model/gltf_file.h"

namespace limpid {
namespace {

using nlohmann::json;
using Bytes = std::vector<unsigned char>;

constexpr int kFloat = 5126, kUnsigned = 5125;

class Writer {
 public:
  explicit Writer(const Model& model) : model_(model) {}

  Bytes write(const std::vector<Bytes>& pictures);

 private:
  int view(const void* bytes, std::size_t size);
  int accessor(int view, int component, const char* type, std::size_t count);
  // Adds the numbers of a field, vertex by vertex.
  template <class Field>
  int stream(const char* type, Field field);
  json material(const Finish& finish) const;

  const Model& model_;
  Bytes data_;
  json views_ = json::array(), accessors_ = json::array();
};

int Writer::view(const void* bytes, std::size_t size) {
  fill_up(data_, 0);
  views_.push_back({{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", size}});
  const auto* first = static_cast<const unsigned char*>(bytes);
  data_.insert(data_.end(), first, first + size);
  return static_cast<int>(views_.size()) - 1;
}

int Writer::accessor(int view, int component, const char* type, std::size_t count) {
  accessors_.push_back(
      {{"bufferView", view}, {"componentType", component}, {"type", type}, {"count", count}});
  return static_cast<int>(accessors_.size()) - 1;
}

template <class Field>
int Writer::stream(const char* type, Field field) {
  std::vector<float> values;
  for (const Vertex& v : model_.vertices) {
    const auto here = field(v);
    values.insert(values.end(), here.data(), here.data() + here.size());
  }
  return accessor(view(values.data(), values.size() * sizeof(float)), kFloat, type,
                  model_.vertices.size());
}

json Writer::material(const Finish& finish) const {
  const Vertex plain;
  json pbr{{"metallicFactor", plain.surface.x()}, {"roughnessFactor", plain.surface.y()}};
  if (finish.color >= 0) pbr["baseColorTexture"] = {{"index", finish.color}};
  json out{{"pbrMetallicRoughness", pbr}, {"doubleSided", finish.two_sided}};
  if (finish.alpha == Finish::Alpha::blend) out["alphaMode"] = "BLEND";
  return out;
}

const char* kind_of(const Bytes& picture) {
  return picture.front() == 0xFF  ? "image/jpeg"
         : picture.front() == 'R' ? "image/webp"
                                  : "image/png";
}

Bytes Writer::write(const std::vector<Bytes>& pictures) {
  json gltf{
      {"asset", {{"version", "2.0"}}}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
  json attributes{{"POSITION", stream("VEC3", [](const Vertex& v) { return v.position; })},
                  {"COLOR_0", stream("VEC4", [](const Vertex& v) {
                     return Eigen::Vector4f(v.color.x(), v.color.y(), v.color.z(), v.opacity);
                   })}};
  if (!pictures.empty()) {
    attributes["TEXCOORD_0"] = stream("VEC2", [](const Vertex& v) { return v.uv; });
  }
  const bool smooth = std::any_of(model_.parts.begin(), model_.parts.end(),
                                  [](const Part& part) { return !part.material.flat; });
  const int normals = smooth ? stream("VEC3", [](const Vertex& v) { return v.normal; }) : -1;
  json primitives = json::array();
  for (const Part& part : model_.parts) {
    json own = attributes;
    if (!part.material.flat) own["NORMAL"] = normals;
    const int indices =
        accessor(view(model_.indices.data() + part.first, part.count * sizeof(std::uint32_t)),
                 kUnsigned, "SCALAR", part.count);
    primitives.push_back(
        {{"attributes", own}, {"indices", indices}, {"material", primitives.size()}});
    gltf["materials"].push_back(material(part.material));
  }
  for (const Bytes& picture : pictures) {
    gltf["textures"].push_back({{"source", gltf["textures"].size()}});
    gltf["images"].push_back(
        {{"bufferView", view(picture.data(), picture.size())}, {"mimeType", kind_of(picture)}});
  }
  gltf["meshes"] = json::array({{{"primitives", primitives}}});
  gltf["accessors"] = accessors_;
  gltf["bufferViews"] = views_;
  gltf["buffers"] = json::array({{{"byteLength", data_.size()}}});
  return glb_bytes(gltf.dump(), data_);
}

}  // namespace

Bytes glb_of(const Model& model, const std::vector<Bytes>& pictures) {
  return Writer(model).write(pictures);
}

}  // namespace limpid
