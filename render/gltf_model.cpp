#include "render/gltf_model.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "render/gltf_accessor.h"

namespace limpid {
namespace {

constexpr std::size_t kLargestFile = std::size_t{64} << 20;
constexpr std::size_t kMostVertices = 4'000'000;
constexpr int kDeepestNode = 64;

class Reader {
 public:
  Reader(const tinygltf::Model& gltf, const std::string& name) : gltf_(gltf), file_(gltf, name) {}

  Model read();

 private:
  Eigen::Affine3d transform(const tinygltf::Node& node) const;
  void add_node(int node, const Eigen::Affine3d& parent, int depth);
  void add_primitive(const tinygltf::Primitive& primitive, const Eigen::Affine3d& to_model);
  void add_indices(const tinygltf::Primitive& primitive, std::uint32_t first, std::size_t count,
                   bool mirrored);
  void add_material(const tinygltf::Primitive& primitive, std::uint32_t first);
  void smooth_normals(std::uint32_t first_vertex, std::size_t first_index);
  int image_of(int texture);

  const tinygltf::Model& gltf_;
  GltfAccessor file_;
  Model model_;
  std::vector<int> image_index_;
};

Eigen::Affine3d Reader::transform(const tinygltf::Node& node) const {
  Eigen::Affine3d out = Eigen::Affine3d::Identity();
  if (node.matrix.size() == 16) {
    out.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
  } else {
    if (node.translation.size() == 3)
      out.translate(Vec3(Eigen::Map<const Vec3>(node.translation.data())));
    if (node.rotation.size() == 4) {
      const Eigen::Quaterniond q(node.rotation[3], node.rotation[0], node.rotation[1],
                                 node.rotation[2]);
      if (!(q.norm() > 1e-6))
        file_.refuse("node \"" + node.name + "\" has a rotation of length zero");
      out.rotate(q.normalized());
    }
    if (node.scale.size() == 3) out.scale(Vec3(Eigen::Map<const Vec3>(node.scale.data())));
  }
  if (!out.matrix().allFinite())
    file_.refuse("node \"" + node.name + "\" has a transform not finite");
  return out;
}

void Reader::add_node(int index, const Eigen::Affine3d& parent, int depth) {
  if (depth > kDeepestNode) file_.refuse("nodes are nested deeper than 64, or in a circle");
  const tinygltf::Node& node = file_.at(gltf_.nodes, index, "node");
  const Eigen::Affine3d here = parent * transform(node);
  if (node.mesh >= 0)
    for (const auto& primitive : file_.at(gltf_.meshes, node.mesh, "mesh").primitives)
      add_primitive(primitive, here);
  for (const int child : node.children) add_node(child, here, depth + 1);
}

void Reader::add_primitive(const tinygltf::Primitive& primitive, const Eigen::Affine3d& to_model) {
  if (primitive.mode != TINYGLTF_MODE_TRIANGLES) file_.refuse("only triangle lists are drawn");
  const auto attribute = [&](const char* key) {
    const auto found = primitive.attributes.find(key);
    return found == primitive.attributes.end() ? -1 : found->second;
  };
  if (attribute("POSITION") < 0) file_.refuse("a mesh has no POSITION");
  const Elements positions = file_.elements(attribute("POSITION"));
  const std::size_t count = positions.count;
  if (positions.components != 3 || positions.component_type != TINYGLTF_COMPONENT_TYPE_FLOAT)
    file_.refuse("POSITION must be three floats");
  if (model_.vertices.size() + count > kMostVertices) file_.refuse("more than 4 million vertices");

  const auto first = static_cast<std::uint32_t>(model_.vertices.size());
  const Eigen::Affine3f move = to_model.cast<float>();
  for (std::size_t i = 0; i < count; ++i) {
    Vertex v;
    v.position = move * file_.element(positions, i).head<3>();
    v.normal = Eigen::Vector3f::UnitZ();
    model_.vertices.push_back(v);
  }
  add_material(primitive, first);
  const std::size_t first_index = model_.indices.size();
  add_indices(primitive, first, count, to_model.linear().determinant() < 0);

  // One optional stream of the primitive into one field of the vertices.
  const auto stream = [&](const char* key, int fewest, auto&& put) {
    if (attribute(key) < 0) return false;
    const Elements e = file_.elements(attribute(key));
    if (e.count != count || e.components < fewest)
      file_.refuse(std::string(key) + " does not match POSITION");
    for (std::size_t i = 0; i < count; ++i) put(model_.vertices[first + i], file_.element(e, i));
    return true;
  };
  const Eigen::Matrix3f turn = move.linear().inverse().transpose();
  const bool has_normals =
      turn.allFinite() && stream("NORMAL", 3, [&](Vertex& v, const auto& n) {
        const Eigen::Vector3f turned = turn * n.template head<3>();
        v.normal = turned.norm() > 1e-12f ? Eigen::Vector3f(turned.normalized()) : v.normal;
      });
  if (!has_normals) smooth_normals(first, first_index);
  stream("TEXCOORD_0", 2, [](Vertex& v, const auto& uv) { v.uv = uv.template head<2>(); });
  stream("COLOR_0", 3,
         [](Vertex& v, const auto& c) { v.color = v.color.cwiseProduct(c.template head<3>()); });
}

void Reader::add_indices(const tinygltf::Primitive& primitive, std::uint32_t first,
                         std::size_t count, bool mirrored) {
  const std::size_t begin = model_.indices.size();
  if (primitive.indices < 0) {
    for (std::size_t i = 0; i < count; ++i)
      model_.indices.push_back(first + static_cast<std::uint32_t>(i));
  } else {
    const Elements e = file_.elements(primitive.indices);
    if (e.components != 1) file_.refuse("indices must be single numbers");
    for (std::size_t i = 0; i < e.count; ++i) {
      const std::uint32_t k = file_.index(e, i);
      if (k >= count)
        file_.refuse("index " + std::to_string(k) + " is outside of the mesh's " +
                     std::to_string(count) + " vertices");
      model_.indices.push_back(first + k);
    }
  }
  if ((model_.indices.size() - begin) % 3 != 0) file_.refuse("indices do not make whole triangles");
  if (mirrored)
    for (std::size_t i = begin; i < model_.indices.size(); i += 3)
      std::swap(model_.indices[i], model_.indices[i + 1]);
  model_.parts.back().first = static_cast<std::uint32_t>(begin);
  model_.parts.back().count = static_cast<std::uint32_t>(model_.indices.size() - begin);
}

void Reader::add_material(const tinygltf::Primitive& primitive, std::uint32_t first) {
  model_.parts.emplace_back();
  if (primitive.material < 0) return;
  const auto& pbr = file_.at(gltf_.materials, primitive.material, "material").pbrMetallicRoughness;
  for (std::size_t i = first; i < model_.vertices.size(); ++i) {
    Vertex& v = model_.vertices[i];
    if (pbr.baseColorFactor.size() >= 3)
      v.color = Eigen::Map<const Vec3>(pbr.baseColorFactor.data()).cast<float>();
    v.surface = Eigen::Vector2d(pbr.metallicFactor, pbr.roughnessFactor).cast<float>();
  }
  if (pbr.baseColorTexture.index >= 0)
    model_.parts.back().image = image_of(pbr.baseColorTexture.index);
}

void Reader::smooth_normals(std::uint32_t first_vertex, std::size_t first_index) {
  std::vector<Eigen::Vector3f> sum(model_.vertices.size() - first_vertex, Eigen::Vector3f::Zero());
  for (std::size_t i = first_index; i < model_.indices.size(); i += 3) {
    const auto corner = [&](std::size_t k) { return model_.indices[i + k]; };
    const auto at_corner = [&](std::size_t k) { return model_.vertices[corner(k)].position; };
    const Eigen::Vector3f n = (at_corner(1) - at_corner(0)).cross(at_corner(2) - at_corner(0));
    for (std::size_t k = 0; k < 3; ++k) sum[corner(k) - first_vertex] += n;
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    if (sum[i].norm() > 0) model_.vertices[first_vertex + i].normal = sum[i].normalized();
}

int Reader::image_of(int texture) {
  const int source = file_.at(gltf_.textures, texture, "texture").source;
  const tinygltf::Image& image = file_.at(gltf_.images, source, "image");
  int& known = image_index_[static_cast<std::size_t>(source)];
  if (known >= 0) return known;
  const auto pixels = static_cast<std::size_t>(std::max(0, image.width)) *
                      static_cast<std::size_t>(std::max(0, image.height));
  if (pixels == 0 || image.bits != 8 || image.component != 4 || image.image.size() != 4 * pixels)
    file_.refuse("image " + std::to_string(source) + " is not a readable 8-bit picture");
  model_.images.push_back({image.width, image.height, image.image});
  return known = static_cast<int>(model_.images.size()) - 1;
}

Model Reader::read() {
  image_index_.assign(gltf_.images.size(), -1);
  if (gltf_.scenes.empty()) file_.refuse("has no scene");
  const auto& scene = file_.at(gltf_.scenes, std::max(0, gltf_.defaultScene), "scene");
  for (const int node : scene.nodes) add_node(node, Eigen::Affine3d::Identity(), 0);
  if (model_.indices.empty()) file_.refuse("contains no triangles");
  return std::move(model_);
}

// A GLB file says its own length; tinygltf trusts it in places, so it is compared first.
void check_glb_header(std::span<const unsigned char> bytes, const std::string& name) {
  std::uint32_t words[3];
  if (bytes.size() < 20) throw std::runtime_error(name + ": is too short for a glTF file");
  std::memcpy(words, bytes.data(), sizeof words);
  if (words[0] != 0x46546C67u)
    throw std::runtime_error(name + ": is not a glTF file (it begins neither with glTF nor {)");
  if (words[1] != 2)
    throw std::runtime_error(name + ": is glTF " + std::to_string(words[1]) + ", not 2");
  if (words[2] != bytes.size())
    throw std::runtime_error(name + ": is truncated or padded, it has " +
                             std::to_string(bytes.size()) + " bytes and says " +
                             std::to_string(words[2]));
}

bool refuse_other_files(std::vector<unsigned char>*, std::string* error, const std::string& path,
                        void*) {
  if (error) *error += "refers to another file, \"" + path + "\"; embed it instead\n";
  return false;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

Model parse_gltf(std::span<const unsigned char> bytes, const std::string& name) {
  if (bytes.size() > kLargestFile)
    throw std::runtime_error(name + ": is larger than the 64 MiB that are read");
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks({[](const std::string&, void*) { return true; },
                         [](const std::string& path, void*) { return path; }, refuse_other_files,
                         [](std::string*, const std::string&, const std::vector<unsigned char>&,
                            void*) { return false; },
                         nullptr});
  tinygltf::Model gltf;
  std::string error, warning;
  const auto length = static_cast<unsigned>(bytes.size());
  bool good = false;
  if (!bytes.empty() && bytes[0] == '{') {
    good = loader.LoadASCIIFromString(&gltf, &error, &warning,
                                      reinterpret_cast<const char*>(bytes.data()), length, "");
  } else {
    check_glb_header(bytes, name);
    good = loader.LoadBinaryFromMemory(&gltf, &error, &warning, bytes.data(), length);
  }
  if (!good)
    throw std::runtime_error(name + ": " +
                             (error.empty() ? "is not valid glTF" : first_line(error)));
  return Reader(gltf, name).read();
}

Model load_gltf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = file ? static_cast<std::streamoff>(file.tellg()) : std::streamoff{-1};
  if (size < 0) throw std::runtime_error(path.string() + ": cannot be read");
  if (static_cast<std::size_t>(size) > kLargestFile)
    throw std::runtime_error(path.string() + ": is larger than the 64 MiB that are read");
  std::vector<unsigned char> bytes(static_cast<std::size_t>(size));
  file.seekg(0).read(reinterpret_cast<char*>(bytes.data()), size);
  if (!file) throw std::runtime_error(path.string() + ": cannot be read");
  return parse_gltf(bytes, path.string());
}

}  // namespace limpid
