#include "render/model/gltf_model.h"

#include <algorithm>
#include <numeric>

#include "render/model/gltf_accessor.h"
#include "render/model/gltf_draco.h"
#include "render/model/gltf_file.h"
#include "render/model/gltf_material.h"
#include "render/model/model_building.h"

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
        poses_(source.gltf.nodes.size(), Eigen::Affine3d::Identity()),
        rest_(source.gltf, file_, poses_) {
    for (const std::string& warning : source.warnings) add_warning(model_, warning);
  }

  Model read();

 private:
  std::vector<int> roots() const;
  Eigen::Affine3d transform(const tinygltf::Node& node) const;
  void place_node(int node, const Eigen::Affine3d& parent, int depth);
  void add_primitive(const tinygltf::Primitive& primitive, int node);
  void add_vertices(const tinygltf::Primitive& primitive, const tinygltf::Node& node,
                    const std::vector<std::uint32_t>& used, const Elements& positions);
  void add_streams(const tinygltf::Primitive& primitive, const std::vector<std::uint32_t>& used,
                   std::size_t count);
  bool add_normals(const tinygltf::Primitive& primitive, const tinygltf::Node& node,
                   const std::vector<std::uint32_t>& used, std::size_t count);

  const tinygltf::Model& gltf_;
  GltfAccessor file_;
  Model model_;
  GltfMaterials materials_;
  LoadProgress progress_;
  std::size_t primitives_ = 0, triangles_ = 0;
  std::vector<bool> seen_;              // nodes
  std::vector<int> with_mesh_;          // nodes, in order
  NodePoses poses_;                     // of nodes
  Eigen::Affine3d to_model_;            // from the present primitive
  std::vector<Eigen::Affine3f> moves_;  // from each vertex to the model, where there is a skin
  GltfRest rest_;
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

void Reader::place_node(int index, const Eigen::Affine3d& parent, int depth) {
  if (depth > kDeepestNode) file_.refuse("has nodes nested deeper than 256");
  const tinygltf::Node& node = file_.at(gltf_.nodes, index, "node");
  // Each node has one parent, so the size of the file bounds the work.
  const auto at = static_cast<std::size_t>(index);
  if (seen_[at])
    file_.refuse("node " + std::to_string(index) +
                 " has two parents or is its own parent, directly or through other nodes");
  seen_[at] = true;
  poses_[at] = parent * transform(node);
  if (node.mesh >= 0) with_mesh_.push_back(index);
  for (const int child : node.children) place_node(child, poses_[at], depth + 1);
}

void Reader::add_primitive(const tinygltf::Primitive& primitive, int index) {
  const tinygltf::Node& node = gltf_.nodes[static_cast<std::size_t>(index)];
  to_model_ = poses_[static_cast<std::size_t>(index)];
  check_wanted(progress_);
  if (++primitives_ > kMostPrimitives)
    file_.refuse("has more than 1 million parts in all nodes together");
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    add_warning(model_, "points and lines are ignored");
    return;
  }
  if (attribute_of(primitive.attributes, "POSITION") < 0) file_.refuse("a mesh has no POSITION");
  decode_draco(primitive, file_, kMostTriangles - triangles_);
  const Elements positions = file_.elements(attribute_of(primitive.attributes, "POSITION"));
  if (positions.components != 3) file_.refuse("POSITION must have three components");

  auto [corners, looked_at] =
      read_triangles(file_, primitive, positions.count, kMostTriangles - triangles_);
  triangles_ += looked_at;
  if (corners.empty()) return;
  const std::vector<std::uint32_t>& used = use_.renumber(corners, positions.count);
  if (model_.vertices.size() + used.size() > kMostVertices)
    file_.refuse("has more than 8 million vertices in all nodes together");
  const auto first = static_cast<std::uint32_t>(model_.vertices.size());
  add_vertices(primitive, node, used, positions);

  // The vertices of a skin come to the scene without to_model_.
  if (moves_.empty() && to_model_.linear().determinant() < 0)
    for (std::size_t i = 0; i < corners.size(); i += 3) std::swap(corners[i], corners[i + 1]);
  Finish finish = materials_.at(primitive.material).material;
  finish.flat = !add_normals(primitive, node, used, positions.count);
  fill_normals(std::span(model_.vertices).subspan(first), corners);
  auto& list = indices_[finish];
  list.reserve(list.size() + corners.size());
  for (const std::uint32_t corner : corners) list.push_back(first + corner);
}

void Reader::add_vertices(const tinygltf::Primitive& primitive, const tinygltf::Node& node,
                          const std::vector<std::uint32_t>& used, const Elements& positions) {
  const GltfMaterial& material = materials_.at(primitive.material);
  moves_ = rest_.moves(node, primitive, used, positions.count);
  const auto shifts = rest_.shifts(node, primitive, "POSITION", used, positions.count);
  for (std::size_t i = 0; i < used.size(); ++i) {
    Vertex v;
    Eigen::Vector3f here = file_.element(positions, used[i]).head<3>();
    if (!shifts.empty()) here += shifts[i];
    v.position = moves_.empty() ? Eigen::Vector3f((to_model_ * here.cast<double>()).cast<float>())
                                : Eigen::Vector3f(moves_[i] * here);
    if (!(v.position.cwiseAbs().maxCoeff() < kFarthest))
      file_.refuse("a vertex is more than 1e6 m from the origin");
    v.normal.setZero();
    v.color = material.color;
    v.opacity = material.opacity;
    v.surface = material.surface;
    model_.vertices.push_back(v);
  }
  add_streams(primitive, used, positions.count);
}

// Puts the optional streams of the primitive into the fields of the vertices.
void Reader::add_streams(const tinygltf::Primitive& primitive,
                         const std::vector<std::uint32_t>& used, std::size_t count) {
  const GltfMaterial& material = materials_.at(primitive.material);
  const std::size_t first = model_.vertices.size() - used.size();
  const auto stream = [&](const std::string& key, int fewest, auto&& put) {
    const int accessor = attribute_of(primitive.attributes, key);
    if (accessor < 0) return;
    Elements e = file_.elements(accessor);
    if (e.count != count || e.components < fewest) file_.refuse(key + " does not match POSITION");
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

// Returns false where there are no normals.
bool Reader::add_normals(const tinygltf::Primitive& primitive, const tinygltf::Node& node,
                         const std::vector<std::uint32_t>& used, std::size_t count) {
  const int accessor = attribute_of(primitive.attributes, "NORMAL");
  const Eigen::Matrix3f turn = to_model_.linear().cast<float>().inverse().transpose();
  if (accessor < 0 || !turn.allFinite()) return false;
  const Elements e = file_.elements(accessor);
  if (e.count != count || e.components < 3) file_.refuse("NORMAL does not match POSITION");
  const auto shifts = rest_.shifts(node, primitive, "NORMAL", used, count);
  const std::size_t first = model_.vertices.size() - used.size();
  for (std::size_t i = 0; i < used.size(); ++i) {
    Eigen::Vector3f own = file_.element(e, used[i]).head<3>();
    if (!shifts.empty()) own += shifts[i];
    const Eigen::Vector3f turned =
        moves_.empty() ? Eigen::Vector3f(turn * own) : Eigen::Vector3f(moves_[i].linear() * own);
    const float length = turned.norm();
    if (length > 1e-12f && std::isfinite(length))
      model_.vertices[first + i].normal = turned / length;
  }
  return true;
}

// Returns the default scene's nodes; of a file without scenes those that no node has as a child.
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

// Extensions for the look of something may be left out, those for its shape may not.
bool may_be_left_out(const std::string& extension) {
  constexpr std::array kKnown = {kDracoExtension, "EXT_meshopt_compression",
                                 "KHR_meshopt_compression", "KHR_mesh_quantization"};
  constexpr std::array kLooks = {"KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_",
                                 "KHR_lights_",    "EXT_lights_",  "KHR_technique"};
  const auto begins = [&](const char* with) { return extension.starts_with(with); };
  return std::find(kKnown.begin(), kKnown.end(), extension) != kKnown.end() ||
         std::any_of(kLooks.begin(), kLooks.end(), begins);
}

Model Reader::read() {
  for (const std::string& name : gltf_.extensionsRequired)
    if (!may_be_left_out(name))
      file_.refuse("requires the extension " + name + ", which Limpid cannot read");
  seen_.assign(gltf_.nodes.size(), false);
  for (const int node : roots()) place_node(node, Eigen::Affine3d::Identity(), 0);
  for (std::size_t i = 0; i < with_mesh_.size(); ++i) {
    const int mesh = gltf_.nodes[static_cast<std::size_t>(with_mesh_[i])].mesh;
    for (const auto& primitive : file_.at(gltf_.meshes, mesh, "mesh").primitives)
      add_primitive(primitive, with_mesh_[i]);
    if (progress_.part)
      *progress_.part = 0.3 + 0.6 * static_cast<double>(i) / static_cast<double>(with_mesh_.size());
  }
  if (!gltf_.animations.empty())
    add_warning(model_, "its animation is ignored: the model does not move");
  if (indices_.empty()) file_.refuse(kNoTriangles);
  join_parts(model_, indices_);
  model_.unit = 1;
  model_.up = Model::Up::y;
  return std::move(model_);
}

}  // namespace

Model parse_gltf(std::span<const unsigned char> bytes, const std::string& name,
                 const std::filesystem::path& folder, const LoadProgress& progress) {
  const GltfFile source = parse_gltf_file(bytes, name, folder);
  if (progress.part) *progress.part = 0.3;
  Model model = Reader(source, name, progress).read();
  check_wanted(progress);
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
