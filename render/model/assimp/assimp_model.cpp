#include "render/model/assimp/assimp_model.h"

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <assimp/ProgressHandler.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string_view>

#include "render/model/assimp/assimp_files.h"
#include "render/model/model_building.h"

namespace limpid {

const AssimpMaterial& AssimpMaterials::at(unsigned index) {
  const auto found = known_.find(index);
  if (found != known_.end()) return found->second;
  AssimpMaterial made;
  if (kind_.materials && index < scene_.mNumMaterials) made = read(*scene_.mMaterials[index]);
  return known_.emplace(index, made).first->second;
}

AssimpMaterial AssimpMaterials::read(const aiMaterial& from) {
  AssimpMaterial to;
  aiString text;
  if (from.Get(AI_MATKEY_NAME, text) == aiReturn_SUCCESS &&
      text == aiString(AI_DEFAULT_MATERIAL_NAME))
    return to;
  aiString file;
  if (from.GetTexture(aiTextureType_DIFFUSE, 0, &file) == aiReturn_SUCCESS && file.length > 0) {
    to.finish.color = picture(file.C_Str());
    to.plain = to.finish.color < 0;
    if (!to.plain) to.color.setOnes();
  }
  aiColor4D diffuse;
  // Black beside a picture is what many exporters write for nothing.
  if (from.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse) == aiReturn_SUCCESS &&
      (to.plain || !diffuse.IsBlack())) {
    to.color = linear({diffuse.r, diffuse.g, diffuse.b});
    to.plain = false;
  }
  float opacity = 1;
  from.Get(AI_MATKEY_OPACITY, opacity);
  // Exporters disagree on which end of the scale is opaque; what nobody could see is not meant.
  if (opacity > 0.02f && opacity < 1) {
    to.opacity = opacity;
    to.finish.alpha = Finish::Alpha::blend;
  }
  to.finish.two_sided = true;  // these formats do not say which side is seen
  return to;
}

int AssimpMaterials::picture(const std::string& file) {
  const auto [place, is_new] = numbers_.try_emplace(file, -1);
  if (!is_new) return place->second;
  auto bytes = files_.read(file);
  if (bytes.empty()) return -1;
  pictures_.push_back(std::move(bytes));
  return place->second = static_cast<int>(pictures_.size()) - 1;
}

namespace {

class Progress : public Assimp::ProgressHandler {
 public:
  explicit Progress(const std::function<void(double)>& tell) : tell_(tell) {}
  bool Update(float) override { return true; }
  void UpdateFileRead(int step, int steps) override {
    if (steps > 0) tell_(0.8 * step / steps);
  }

 private:
  const std::function<void(double)>& tell_;
};

// Keeps only the importer of this kind: assimp guesses at others by what a file contains.
void keep_importer(Assimp::Importer& importer, const ModelKind& kind) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* const each = importer.GetImporter(i);
    if (importer.GetImporter(std::string(kind.suffix).c_str()) == each) continue;
    importer.UnregisterLoader(each);
    delete each;  // it is the caller's now
  }
}

// Says in words for the owner what assimp says about a file of points or lines only.
std::string in_words(const std::string& why) {
  for (const char* said : {"No meshes remaining", "invalid primitive type", "no facets"})
    if (why.find(said) != why.npos) return kNoTriangles;
  if (why.find("STL storage representation") != why.npos)
    return "is not an STL file: its length does not match its number of triangles, and it is not a "
           "text file";
  constexpr std::string_view kNoNumber = "Cannot parse string \"";
  if (const std::size_t at = why.find(kNoNumber); at != why.npos) {
    const std::string found = why.substr(at + kNoNumber.size());
    return "there should be a number, but there is \"" +
           found.substr(0, found.find_first_of("?\n\r\"")) + "\"";
  }
  return why.empty() ? "is not valid" : why;
}

Eigen::Affine3d transform(const aiMatrix4x4& m) {
  Eigen::Affine3d out;
  out.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, 0, 0, 0,
      1;
  return out;
}

[[noreturn]] void refuse(const std::string& why) { throw std::runtime_error(one_line(why)); }

Eigen::Vector3f vec(const aiVector3D& v) { return {v.x, v.y, v.z}; }

class Builder {
 public:
  Builder(const aiScene& scene, const ModelKind& kind, AssimpFiles& files)
      : scene_(scene), use_normals_(kind.normals), materials_(scene, kind, files) {}

  AssimpModel build();

 private:
  void add_node(const aiNode& node, const Eigen::Affine3d& parent, int depth);
  void add_mesh(const aiMesh& mesh, const Eigen::Affine3d& to_model);
  std::size_t weld(const aiMesh& mesh, bool normals, std::vector<unsigned>& place) const;
  void add_vertices(const aiMesh& mesh, bool normals, const Eigen::Affine3d& to_model,
                    std::span<const unsigned> place, std::size_t count);

  const aiScene& scene_;
  bool use_normals_;
  Model model_;
  AssimpMaterials materials_;
  std::size_t triangles_ = 0, nodes_ = 0;
  IndicesByFinish indices_;
};

// Welds equal vertices: formats that list corners have each vertex many times.
std::size_t Builder::weld(const aiMesh& mesh, bool normals, std::vector<unsigned>& place) const {
  std::vector<meshopt_Stream> streams{{mesh.mVertices, sizeof(aiVector3D), sizeof(aiVector3D)}};
  const auto also = [&](const auto* values) {
    if (values != nullptr) streams.push_back({values, sizeof *values, sizeof *values});
  };
  if (normals) also(mesh.mNormals);
  also(mesh.mTextureCoords[0]);
  also(mesh.mColors[0]);
  place.resize(mesh.mNumVertices);
  // The list is filled up to whole triangles, which the library wants.
  std::vector<unsigned> all((std::size_t{mesh.mNumVertices} + 2) / 3 * 3, mesh.mNumVertices - 1);
  std::iota(all.begin(), all.begin() + mesh.mNumVertices, 0u);
  return meshopt_generateVertexRemapMulti(place.data(), all.data(), all.size(), mesh.mNumVertices,
                                          streams.data(), streams.size());
}

void Builder::add_vertices(const aiMesh& mesh, bool normals, const Eigen::Affine3d& to_model,
                           std::span<const unsigned> place, std::size_t count) {
  const AssimpMaterial& material = materials_.at(mesh.mMaterialIndex);
  const Eigen::Matrix3f turn = to_model.linear().cast<float>().inverse().transpose();
  const std::size_t first = model_.vertices.size();
  model_.vertices.resize(first + count);
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    Vertex& v = model_.vertices[first + place[i]];
    v.position = (to_model * vec(mesh.mVertices[i]).cast<double>()).cast<float>();
    if (!v.position.allFinite()) refuse("a vertex has a coordinate that is not a finite number");
    if (v.position.cwiseAbs().maxCoeff() >= kFarthest)
      refuse("a vertex is more than a million units from the origin");
    v.normal.setZero();
    if (normals) {
      const Eigen::Vector3f n = turn * vec(mesh.mNormals[i]);
      if (n.norm() > 1e-12f && std::isfinite(n.norm())) v.normal = n.normalized();
    }
    if (mesh.HasTextureCoords(0)) {
      const aiVector3D& uv = mesh.mTextureCoords[0][i];  // counted from below
      const Eigen::Vector2f own(uv.x, 1 - uv.y);
      v.uv = own.allFinite() ? own.cwiseMax(-kFarthest).cwiseMin(kFarthest).eval() : v.uv;
    }
    v.color = material.color;
    v.opacity = material.opacity;
    if (mesh.HasVertexColors(0)) {
      const aiColor4D& c = mesh.mColors[0][i];
      const Eigen::Vector3f own = linear({c.r, c.g, c.b});
      v.color = material.plain ? own : v.color.cwiseProduct(own).eval();
    }
  }
}

void Builder::add_mesh(const aiMesh& mesh, const Eigen::Affine3d& to_model) {
  if (!to_model.matrix().allFinite()) refuse("has a transform that is not finite");
  if (mesh.mNumFaces == 0 || !mesh.HasPositions()) return;
  if ((triangles_ += mesh.mNumFaces) > kMostTriangles)
    refuse("has more than 6 million triangles in all nodes together");
  const bool normals = use_normals_ && mesh.HasNormals();
  std::vector<unsigned> place;
  const std::size_t count = weld(mesh, normals, place);
  const std::size_t first = model_.vertices.size();
  if (first + count > kMostVertices)
    refuse("has more than 8 million vertices in all nodes together");
  add_vertices(mesh, normals, to_model, place, count);

  std::vector<std::uint32_t> corners;
  corners.reserve(3 * std::size_t{mesh.mNumFaces});
  const bool mirrored = to_model.linear().determinant() < 0;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices != 3) continue;
    std::array<std::uint32_t, 3> at{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices) refuse("refers to a vertex that does not exist");
      at[k] = place[face.mIndices[k]];
    }
    if (mirrored) std::swap(at[0], at[1]);
    if (at[0] != at[1] && at[1] != at[2] && at[2] != at[0])
      corners.insert(corners.end(), at.begin(), at.end());
  }
  fill_normals(std::span(model_.vertices).subspan(first), corners);
  Finish finish = materials_.at(mesh.mMaterialIndex).finish;
  finish.flat = !normals;
  auto& list = indices_[finish];
  list.reserve(list.size() + corners.size());
  for (const std::uint32_t corner : corners)
    list.push_back(static_cast<std::uint32_t>(first) + corner);
}

void Builder::add_node(const aiNode& node, const Eigen::Affine3d& parent, int depth) {
  if (depth > kDeepestNode) refuse("has nodes nested deeper than 256");
  if (++nodes_ > kMostNodes) refuse("has more than 1 million nodes");
  const Eigen::Affine3d here = parent * transform(node.mTransformation);
  for (unsigned i = 0; i < node.mNumMeshes; ++i) add_mesh(*scene_.mMeshes[node.mMeshes[i]], here);
  for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(*node.mChildren[i], here, depth + 1);
}

AssimpModel Builder::build() {
  add_node(*scene_.mRootNode, Eigen::Affine3d::Identity(), 0);
  join_parts(model_, indices_);
  if (model_.indices.empty()) refuse(kNoTriangles);
  return {std::move(model_), materials_.pictures(), false};
}

}  // namespace

AssimpModel read_with_assimp(AssimpFiles* files, const ModelKind& kind,
                             const std::function<void(double)>& progress) {
  Assimp::Importer importer;
  importer.SetIOHandler(files);  // owns it from now on, as the next
  importer.SetProgressHandler(new Progress(progress));
  keep_importer(importer, kind);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* const scene =
      importer.ReadFile(files->main(), aiProcess_Triangulate | aiProcess_SortByPType);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    const std::string why = importer.GetErrorString();
    if (why.find("bad_alloc") != why.npos) throw std::bad_alloc();
    refuse(in_words(why));
  }
  AssimpModel out = Builder(*scene, kind, *files).build();
  out.model.warnings = files->warnings();
  out.outside = files->any_read();
  return out;
}

}  // namespace limpid
