#include "render/model/gltf_rest.h"

#include <cmath>

namespace limpid {

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
    if (!out.back().matrix().allFinite()) file_.refuse("has a skin that is not finite");
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
