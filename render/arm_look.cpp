#include "render/arm_look.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "render/mesh_shapes.h"
#include "render/model/model_file.h"
#include "render/model/simplify.h"

namespace limpid {
namespace {

using Models = std::map<std::string, std::shared_ptr<const Model>>;

// glTF has y up; arms have z up, and so have STL, OBJ and Collada in URDF, whatever they say.
bool is_gltf(const std::filesystem::path& file) {
  std::string suffix = file.extension().string();
  for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return suffix == ".glb" || suffix == ".gltf";
}

Model upright(Model model) {
  for (Vertex& v : model.vertices) {
    v.position = Eigen::Vector3f(v.position.x(), -v.position.z(), v.position.y());
    v.normal = Eigen::Vector3f(v.normal.x(), -v.normal.z(), v.normal.y());
  }
  return model;
}

float linear(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

Paint paint_of(const Visual& visual) {
  Paint paint{{0.75f, 0.76f, 0.78f}, 0, 0.4f};
  if (visual.color) paint.color = visual.color->head<3>().unaryExpr(&linear);
  return paint;
}

// Neither colours nor pictures of its own, as an STL.
bool unpainted(const Model& model) {
  const Eigen::Vector3f none = Vertex{}.color;
  return model.images.empty() &&
         std::ranges::all_of(model.vertices, [&](const Vertex& v) { return v.color == none; });
}

void stretch(Model& model, const Vec3& by) {
  const Eigen::Vector3f scale = by.cast<float>();
  for (Vertex& v : model.vertices) {
    v.position = v.position.cwiseProduct(scale);
    v.normal = v.normal.cwiseQuotient(scale).normalized();
  }
  if (scale.prod() > 0) return;
  for (auto* corners :
       {&model.indices, &model.coarse}) {  // seen in a mirror they run the other way
    for (std::size_t i = 0; i + 2 < corners->size(); i += 3) {
      std::swap((*corners)[i], (*corners)[i + 1]);
    }
  }
}

Model model_of(const Visual& visual) {
  const Paint paint = paint_of(visual);
  const Vec3& size = visual.size;
  switch (visual.shape) {
    case Visual::Shape::box: return make_box(size, 0.1 * size.minCoeff(), paint);
    case Visual::Shape::cylinder: return make_cylinder(size.x(), size.y(), paint);
    case Visual::Shape::sphere: return make_sphere(size.x(), paint);
    case Visual::Shape::mesh:
    case Visual::Shape::stand_in: break;
  }
  Model model = *visual.model;
  stretch(model, size);
  if (unpainted(model)) {
    for (Vertex& v : model.vertices) {
      v.color = paint.color;
      v.surface = {paint.metallic, paint.roughness};
    }
  }
  return model;
}

// Empty files and files of nothing but a point show nothing.
std::shared_ptr<const Model> read(const Visual& visual, const LoadProgress& progress) {
  Model model = load_model_file(visual.mesh, progress);
  if (is_gltf(visual.mesh)) model = upright(std::move(model));
  const Bounds box = model.bounds();
  if (model.indices.empty() || box.isEmpty() || !(box.diagonal().norm() > 0)) {
    throw std::runtime_error(visual.mesh + ": nothing to see in it");
  }
  add_coarse(model);
  return std::make_shared<const Model>(std::move(model));
}

Item body(const ArmDescription& arm, std::size_t i, double reach) {
  const Paint paint = paint_of({});
  const double n = static_cast<double>(std::max(1, arm.dof()));
  const double radius = std::clamp(0.16 * reach / n, 0.003, 0.03);
  const bool last = i + 1 == arm.joints.size();
  Model link = make_capsule(Vec3::Zero(), end_of(arm, i), last ? 0.7 * radius : radius, paint);
  if (arm.slides(i)) {  // a rod as long as its travel
    const Joint& joint = arm.joints[i];
    append(link, make_capsule(Vec3::Zero(), -kSlideUnit * joint.upper * joint.axis, radius, paint));
  }
  if (last) {
    Model tip = make_sphere(radius, paint);
    transform(tip, Eigen::Affine3d(Eigen::Translation3d(end_of(arm, i))));
    append(link, tip);
  }
  return {std::move(link), Pose::Identity(), static_cast<int>(i)};
}

Item foot(const ArmDescription& arm, double reach) {
  const double n = static_cast<double>(std::max(1, arm.dof()));
  const double radius = std::clamp(0.16 * reach / n, 0.003, 0.03);
  return {make_sphere(1.5 * radius, paint_of({})), Pose::Identity(), -1};
}

}  // namespace

Vec3 end_of(const ArmDescription& arm, std::size_t i) {
  return i + 1 < arm.joints.size() ? Vec3(arm.joints[i + 1].origin.translation())
                                   : Vec3(arm.tip.translation());
}

void load_visuals(ArmDescription& arm, const LoadProgress& progress) {
  Models known;
  double done = 0;
  for (Visual& visual : arm.visuals) {
    if (progress.part) *progress.part = done++ / static_cast<double>(arm.visuals.size());
    if (visual.shape != Visual::Shape::mesh || visual.model) continue;
    const auto [at, fresh] = known.try_emplace(visual.mesh);
    if (fresh) {
      try {
        at->second = read(visual, {.part = nullptr, .cancel = progress.cancel});
      } catch (const LoadCancelled&) {
        throw;
      } catch (const std::exception& e) {
        arm.warnings.push_back(std::string(e.what()) + "; a plain shape stands for it");
      }
    }
    visual.model = at->second;
    if (!visual.model) visual.shape = Visual::Shape::stand_in;
  }
}

void add_arm(const ArmDescription& arm, SceneItems& items) {
  std::set<int> seen, wanted;
  for (const Visual& visual : arm.visuals) {
    if (visual.shape == Visual::Shape::stand_in) {
      wanted.insert(visual.link);
      continue;
    }
    seen.insert(visual.link);
    auto& list = visual.link < 0 ? items.base : items.moving;
    list.push_back({model_of(visual), visual.origin, visual.link});
  }
  if (arm.visuals.empty()) {
    for (int i = -1; i < arm.dof(); ++i) wanted.insert(i);
  }
  for (const int i : wanted) {
    if (seen.contains(i)) continue;
    if (i < 0) {
      items.base.push_back(foot(arm, items.reach));
    } else {
      items.moving.push_back(body(arm, static_cast<std::size_t>(i), items.reach));
    }
  }
}

}  // namespace limpid
