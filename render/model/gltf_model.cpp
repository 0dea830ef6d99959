#include "render/model/gltf_model.h"

#include <algorithm>
#include <numeric>

#include "render/model/gltf_accessor.h"
#include "render/model/gltf_file.h"
#include "render/model/gltf_material.h"
#include "render/model/gltf_triangles.h"
#include "render/model/model_building.h"
#include "render/model/simplify.h"

namespace limpid {
namespace {

constexpr std::size_t kMostPrimitives = 1'000'000;  // over all nodes

class Reader {
 public:
  Reader(const GltfFile& source, const std::string& name, const LoadProgress& progress)
      : gltf_(source.gltf),
        file_(source.gltf, name),
        materials_(source, file_, name, model_),
        progress_(progress),
        expected_(std::max<std::size_t>(1, source.gltf.nodes.size())) {
    for (const std::string& warning : source.warnings) add_warning(model_, warning);
  }

  Model read();

 private:
  std::vector<int> roots() const;
  Eigen::Affine3d transform(const tinygltf::Node& node) const;
  void add_node(int node, const Eigen::Affine3d& parent, int depth);
  void add_primitive(const tinygltf::Primitive& primitive, const Eigen::Affine3d& to_model);
  void add_vertices(const tinygltf::Primitive& primitive, const std::vector<std::uint32_t>& used,
                    const Elements& positions, const Eigen::Affine3d& to_model);
  bool add_normals(const tinygltf::Primitive& primitive, const std::vector<std::uint32_t>& used,
                   std::size_t count, const Eigen::Affine3d& to_model);

  const tinygltf::Model& gltf_;
  GltfAccessor file_;
  Model model_;
  GltfMaterials materials_;
  LoadProgress progress_;
  std::size_t expected_, nodes_ = 0, primitives_ = 0, triangles_ = 0;
  std::vector<bool> seen_;  // nodes
  VertexUse use_;
  IndicesByFinish indices_;
};

Eigen::Affine3d Reader::transform(const tinygltf::Node& node) const {
  Eigen::Affine3d out = Eigen::Affine3d::Identity();
  if (node.matrix.size() == 16) {
    out.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
    out.makeAffine();
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
    file_.refuse("node \"" + node.name + "\" has a transform that is not finite");
  return out;
}

void Reader::add_node(int index, const Eigen::Affine3d& parent, int depth) {
  if (depth > kDeepestNode) file_.refuse("has nodes nested deeper than 256");
  const tinygltf::Node& node = file_.at(gltf_.nodes, index, "node");
  // With one parent a node, the work is bounded by the size of the file.
  if (seen_[static_cast<std::size_t>(index)])
    file_.refuse("node " + std::to_string(index) + " has two parents or is in a circle");
  seen_[static_cast<std::size_t>(index)] = true;
  const Eigen::Affine3d here = parent * transform(node);
  if (node.skin >= 0) add_warning(model_, "skins are left out: shown as modelled");
  if (node.mesh >= 0)
    for (const auto& primitive : file_.at(gltf_.meshes, node.mesh, "mesh").primitives)
      add_primitive(primitive, here);
  if (progress_.part)
    *progress_.part = 0.3 + 0.6 * static_cast<double>(++nodes_) / static_cast<double>(expected_);
  for (const int child : node.children) add_node(child, here, depth + 1);
}

int attribute(const tinygltf::Primitive& primitive, const std::string& key) {
  const auto found = primitive.attributes.find(key);
  return found == primitive.attributes.end() ? -1 : found->second;
}

void Reader::add_primitive(const tinygltf::Primitive& primitive, const Eigen::Affine3d& to_model) {
  check_wanted(progress_);
  if (++primitives_ > kMostPrimitives) file_.refuse("has more than 1 million parts over all nodes");
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    add_warning(model_, "points and lines are left out");
    return;
  }
  if (primitive.extensions.count("KHR_draco_mesh_compression") != 0 &&
      attribute(primitive, "POSITION") >= 0 &&
      file_.at(gltf_.accessors, attribute(primitive, "POSITION"), "accessor").bufferView < 0)
    file_.refuse("is compressed with KHR_draco_mesh_compression, which is not read");
  if (attribute(primitive, "POSITION") < 0) file_.refuse("a mesh has no POSITION");
  const Elements positions = file_.elements(attribute(primitive, "POSITION"));
  if (positions.components != 3) file_.refuse("POSITION must have three components");

  auto [corners, looked_at] =
      read_triangles(file_, primitive, positions.count, kMostTriangles - triangles_);
  triangles_ += looked_at;
  if (corners.empty()) return;
  const std::vector<std::uint32_t>& used = use_.renumber(corners, positions.count);
  if (model_.vertices.size() + used.size() > kMostVertices)
    file_.refuse("has more than 8 million vertices over all nodes");
  const auto first = static_cast<std::uint32_t>(model_.vertices.size());
  add_vertices(primitive, used, positions, to_model);

  if (to_model.linear().determinant() < 0)
    for (std::size_t i = 0; i < corners.size(); i += 3) std::swap(corners[i], corners[i + 1]);
  Finish finish = materials_.at(primitive.material).material;
  finish.flat = !add_normals(primitive, used, positions.count, to_model);
  fill_normals(std::span(model_.vertices).subspan(first), corners);
  auto& list = indices_[finish];
  list.reserve(list.size() + corners.size());
  for (const std::uint32_t corner : corners) list.push_back(first + corner);
}

void Reader::add_vertices(const tinygltf::Primitive& primitive,
                          const std::vector<std::uint32_t>& used, const Elements& positions,
                          const Eigen::Affine3d& to_model) {
  const GltfMaterial& material = materials_.at(primitive.material);
  const std::size_t first = model_.vertices.size();
  for (const std::uint32_t i : used) {
    Vertex v;
    const Vec3 here = file_.element(positions, i).head<3>().cast<double>();
    v.position = (to_model * here).cast<float>();
    if (!(v.position.cwiseAbs().maxCoeff() < kFarthest))
      file_.refuse("a vertex is farther than 1000 km from the origin");
    v.normal.setZero();
    v.color = material.color;
    v.opacity = material.opacity;
    v.surface = material.surface;
    model_.vertices.push_back(v);
  }
  // One optional stream of the primitive into the fields of the vertices.
  const auto stream = [&](const std::string& key, int fewest, auto&& put) {
    const int accessor = attribute(primitive, key);
    if (accessor < 0) return;
    Elements e = file_.elements(accessor);
    if (e.count != positions.count || e.components < fewest)
      file_.refuse(key + " does not match POSITION");
    if (key == "COLOR_0") e.normalized = true;  // always, though some files do not say so
    for (std::size_t i = 0; i < used.size(); ++i)
      put(model_.vertices[first + i], file_.element(e, used[i]));
  };
  stream("TEXCOORD_" + std::to_string(material.uv_set), 2, [&](Vertex& v, const auto& uv) {
    v.uv = (material.uv_move * uv.template head<2>()).cwiseMax(-kFarthest).cwiseMin(kFarthest);
  });
  const bool alpha = material.material.alpha != Finish::Alpha::opaque;
  stream("COLOR_0", 3, [&](Vertex& v, const auto& c) {
    const Eigen::Vector4f color = c.cwiseMax(0.0f).cwiseMin(1.0f);
    v.color = v.color.cwiseProduct(color.template head<3>());
    if (alpha) v.opacity *= color[3];
  });
}

// False where there are none.
bool Reader::add_normals(const tinygltf::Primitive& primitive,
                         const std::vector<std::uint32_t>& used, std::size_t count,
                         const Eigen::Affine3d& to_model) {
  const int accessor = attribute(primitive, "NORMAL");
  const Eigen::Matrix3f turn = to_model.linear().cast<float>().inverse().transpose();
  if (accessor < 0 || !turn.allFinite()) return false;
  const Elements e = file_.elements(accessor);
  if (e.count != count || e.components < 3) file_.refuse("NORMAL does not match POSITION");
  const std::size_t first = model_.vertices.size() - used.size();
  for (std::size_t i = 0; i < used.size(); ++i) {
    const Eigen::Vector3f turned = turn * file_.element(e, used[i]).head<3>();
    const float length = turned.norm();
    if (length > 1e-12f && std::isfinite(length))
      model_.vertices[first + i].normal = turned / length;
  }
  return true;
}

// The default scene's nodes; of a file without scenes those that nobody has as a child.
std::vector<int> Reader::roots() const {
  if (!gltf_.scenes.empty())
    return file_.at(gltf_.scenes, std::max(0, gltf_.defaultScene), "scene").nodes;
  std::vector<int> all(gltf_.nodes.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<bool> child(gltf_.nodes.size());
  for (const auto& node : gltf_.nodes)
    for (const int i : node.children) {
      file_.at(gltf_.nodes, i, "node");
      child[static_cast<std::size_t>(i)] = true;
    }
  std::erase_if(all, [&](int i) { return child[static_cast<std::size_t>(i)]; });
  return all;
}

Model Reader::read() {
  constexpr std::array kKnown = {"KHR_texture_transform", "KHR_mesh_quantization",
                                 "KHR_lights_punctual"};
  for (const std::string& name : gltf_.extensionsRequired)
    if (std::find(kKnown.begin(), kKnown.end(), name) == kKnown.end() &&
        !name.starts_with("KHR_materials_"))
      file_.refuse("requires the extension " + name + ", which is not read");
  seen_.assign(gltf_.nodes.size(), false);
  for (const int node : roots()) add_node(node, Eigen::Affine3d::Identity(), 0);
  if (indices_.empty()) file_.refuse(kNoTriangles);
  join_parts(model_, indices_);
  model_.unit = 1;
  model_.up = Model::Up::y;
  return std::move(model_);
}

}  // namespace

Model parse_gltf(std::span<const unsigned char> bytes, const std::string& name,
                 const std::filesystem::path& folder, const LoadProgress& progress) {
  Model model;
  {
    const GltfFile source = parse_gltf_file(bytes, name, folder);
    if (progress.part) *progress.part = 0.3;
    model = Reader(source, name, progress).read();
  }  // the file's buffers go before more memory is needed
  check_wanted(progress);
  add_coarse(model);
  if (progress.part) *progress.part = 1;
  return model;
}

Model load_gltf(const std::filesystem::path& path, const LoadProgress& progress) {
  const auto bytes = read_bytes(path, kLargestModelFiles);
  if (progress.part) *progress.part = 0.1;
  const auto folder = path.parent_path();
  return parse_gltf(bytes, path.string(), folder.empty() ? "." : folder, progress);
}

}  // namespace limpid
