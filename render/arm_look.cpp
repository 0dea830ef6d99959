#include "render/arm_look.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "render/mesh_shapes.h"
#include "render/model/model_file.h"
#include "render/model/simplify.h"
#include "render/upright.h"

namespace limpid {
namespace {

constexpr double kSeen = 1e-3;  // shorter links are not missed where others have pictures [m]

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
Model read(const std::string& file, const LoadProgress& progress) {
  Model model = load_model_file(file, progress);
  const Bounds box = model.bounds();
  if (model.indices.empty() || box.isEmpty() || !(box.diagonal().norm() > 0)) {
    throw std::runtime_error(file + ": nothing to see in it");
  }
  return model;
}

// The models of the visuals that have none, as their files have them; what cannot be read is a line
// in the arm's warnings.
std::map<std::string, Model> read_models(ArmDescription& arm, const LoadProgress& progress) {
  std::map<std::string, Model> models;
  std::set<std::string> tried;
  double done = 0;
  for (const Visual& visual : arm.visuals) {
    if (progress.part) *progress.part = done++ / static_cast<double>(arm.visuals.size());
    if (visual.shape != Visual::Shape::mesh || visual.model) continue;
    if (!tried.insert(visual.mesh).second) continue;
    try {
      models[visual.mesh] = read(visual.mesh, {.part = nullptr, .cancel = progress.cancel});
    } catch (const LoadCancelled&) {
      throw;
    } catch (const std::exception& e) {
      arm.warnings.push_back(std::string(e.what()) + "; a plain shape stands for it");
    }
  }
  return models;
}

void say_z_up(ArmDescription& arm, const std::set<std::string>& files) {
  if (files.empty()) return;
  std::string names;
  std::size_t named = 0;
  for (const std::string& file : files) {
    if (++named > 3) continue;
    names += (names.empty() ? "" : ", ") + std::filesystem::path(file).filename().string();
  }
  if (named > 3) names += " and " + std::to_string(named - 3) + " more";
  arm.warnings.push_back(names + (named == 1 ? " has" : " have") +
                         " z up, where glTF says y up: not turned, because " +
                         (named == 1 ? "it fits its link" : "they fit their links") + " as " +
                         (named == 1 ? "it is" : "they are"));
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

void load_visuals(ArmDescription& arm, std::span<const Visual> collisions,
                  const LoadProgress& progress) {
  std::map<std::string, Model> models = read_models(arm, progress);
  // STL, OBJ and Collada have z up in URDF, whatever they say.
  const std::set<std::string> z_up = with_z_up(arm, models, collisions, progress);
  say_z_up(arm, z_up);
  std::map<std::string, std::shared_ptr<const Model>> ready;
  for (auto& [file, model] : models) {
    if (is_gltf(file) && !z_up.contains(file)) stand_upright(model);
    add_coarse(model);
    ready[file] = std::make_shared<const Model>(std::move(model));
  }
  for (Visual& visual : arm.visuals) {
    if (visual.shape != Visual::Shape::mesh || visual.model) continue;
    visual.model = ready[visual.mesh];
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
  if (arm.visuals.empty()) wanted.insert(-1);
  for (int i = 0; i < arm.dof(); ++i) {
    if (arm.visuals.empty() || end_of(arm, static_cast<std::size_t>(i)).norm() > kSeen ||
        arm.slides(static_cast<std::size_t>(i))) {
      wanted.insert(i);
    }
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
