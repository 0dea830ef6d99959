#include "app/desktop/document/scene_editor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>

#include "devices/files/rpy.h"
#include "devices/files/scene/material_keys.h"
#include "devices/files/scene/model_units.h"
#include "devices/files/scene/scene_limits.h"
#include "render/scene_items.h"

namespace limpid {
namespace {

using namespace scene_limits;

// Calls `visit` with the list of one kind.
template <class S, class Visit>
decltype(auto) with_list(S& scene, ObjectKind kind, Visit&& visit) {
  switch (kind) {
    case ObjectKind::sphere: return visit(scene.spheres);
    case ObjectKind::box: return visit(scene.boxes);
    case ObjectKind::mesh: return visit(scene.meshes);
    case ObjectKind::joint_contact: return visit(scene.joint_contacts);
    case ObjectKind::plane: break;
  }
  return visit(scene.planes);
}

constexpr std::array kKinds{ObjectKind::plane, ObjectKind::sphere, ObjectKind::box,
                            ObjectKind::mesh, ObjectKind::joint_contact};

std::size_t count(const Scene& scene, ObjectKind kind) {
  return with_list(scene, kind, [](const auto& list) { return list.size(); });
}

void hold(double& x, const Range& range, double otherwise) { x = range.hold(x, otherwise); }
void hold(Vec3& v, const Range& range, double otherwise) {
  for (double& x : v) hold(x, range, otherwise);
}
void hold(Pose& pose) {
  Vec3 at = pose.translation();
  hold(at, kPosition, 0);
  pose.translation() = at;
  pose.linear() = pose.linear().allFinite() ? settled(pose.linear()) : Mat3::Identity();
}

// Within what a file may say.
void hold(Plane& plane) {
  hold(plane.point, kPosition, 0);
  const double length = plane.normal.stableNorm();
  const bool direction = std::isfinite(length) && length > 1e-9;
  plane.normal = direction ? Vec3(plane.normal / length) : Vec3(Vec3::UnitZ());
  hold(plane.material);
}
void hold(Sphere& sphere) {
  hold(sphere.center, kPosition, 0);
  hold(sphere.radius, kLength, Sphere{}.radius);
  hold(sphere.material);
}
void hold(Box& box) {
  hold(box.pose);
  hold(box.size, kLength, 0.1);
  hold(box.material);
}
void hold(MeshObstacle& mesh) {
  hold(mesh.pose);
  hold(mesh.scale, kScale, 1);
  if (model_unit(mesh.unit) == nullptr) mesh.unit = 1;
  hold(mesh.material);
}
void hold(JointContact& contact) {
  hold(contact.angle, kAngle, 0);
  contact.direction = contact.direction < 0 ? -1 : 1;
  hold(contact.stiffness, kJointStiffness, JointContact{}.stiffness);
}

// A little beside the first one, to be seen.
void move_aside(SceneObject& object, double by) {
  if (auto* plane = std::get_if<Plane>(&object)) plane->point += by * plane->normal;
  if (auto* sphere = std::get_if<Sphere>(&object)) sphere->center.y() += by;
  if (auto* box = std::get_if<Box>(&object)) box->pose.translation().y() += by;
  if (auto* mesh = std::get_if<MeshObstacle>(&object)) mesh->pose.translation().y() += by;
}

}  // namespace

std::vector<ObjectRef> objects_of(const Scene& scene) {
  std::vector<ObjectRef> all;
  for (const ObjectKind kind : kKinds) {
    for (std::size_t i = 0; i < count(scene, kind); ++i) all.push_back({kind, i});
  }
  return all;
}

SceneObject object_of(const Scene& scene, const ObjectRef& ref) {
  return with_list(scene, ref.kind,
                   [&](const auto& list) -> SceneObject { return list.at(ref.index); });
}

const std::string& name_of(const Scene& scene, const ObjectRef& ref) {
  return with_list(scene, ref.kind,
                   [&](const auto& list) -> const std::string& { return list.at(ref.index).name; });
}

const char* kind_name(ObjectKind kind) {
  constexpr std::array names{"plane", "sphere", "box", "mesh", "joint stop"};
  return names[static_cast<std::size_t>(kind)];
}

Eigen::AlignedBox3d bounds_of(const SceneObject& object, const Model* model) {
  Eigen::AlignedBox3d box;
  if (const auto* sphere = std::get_if<Sphere>(&object)) {
    const Vec3 r = Vec3::Constant(sphere->radius);
    box = {sphere->center - r, sphere->center + r};
  } else if (const auto* cuboid = std::get_if<Box>(&object)) {
    box = Eigen::AlignedBox3d(Vec3(-cuboid->size / 2), Vec3(cuboid->size / 2));
    box = moved(box, Eigen::Affine3d(cuboid->pose));
  } else if (const auto* mesh = std::get_if<MeshObstacle>(&object); mesh && model) {
    box = moved(model->bounds(), Eigen::Affine3d(mesh->stood()) * Eigen::Scaling(mesh->size()));
  }
  return box;
}

void SceneEditor::open(SceneDocument document, MeshModels models, bool saved) {
  now_ = {std::make_shared<const World>(World{std::move(document), std::move(models)}),
          std::nullopt};
  saved_ = saved ? now_.world : nullptr;
  last_change_.clear();
}

void SceneEditor::restore(const Version& version) {
  now_ = version;
  last_change_.clear();
}

void SceneEditor::saved(SceneDocument document) {
  now_.world = std::make_shared<const World>(World{std::move(document), models()});
  saved_ = now_.world;
}

template <class Change>
void SceneEditor::change(std::string what, Change&& change) {
  World next = *now_.world;
  change(next);
  // The text no longer tells what is there; settled rotations are those that a new one can.
  next.document.toml.clear();
  Scene& scene = next.document.scene;
  for (Box& box : scene.boxes) box.pose.linear() = settled(box.pose.linear());
  for (MeshObstacle& mesh : scene.meshes) mesh.pose.linear() = settled(mesh.pose.linear());
  now_.world = std::make_shared<const World>(std::move(next));
  last_change_ = std::move(what);
}

void SceneEditor::select_next(int step) {
  const std::vector<ObjectRef> all = objects_of(scene());
  if (all.empty()) return;
  const auto size = static_cast<int>(all.size());
  int at = step > 0 ? -1 : size;
  if (now_.selected) {
    at = static_cast<int>(std::ranges::find(all, *now_.selected) - all.begin());
  }
  now_.selected = all[static_cast<std::size_t>(((at + step) % size + size) % size)];
}

void SceneEditor::set(const ObjectRef& ref, SceneObject object, const std::string& what) {
  std::visit([](auto& o) { hold(o); }, object);
  const std::string full = fmt::format("{} {} {}", kind_name(ref.kind), ref.index, what);
  change(full, [&](World& world) {
    with_list(world.document.scene, ref.kind, [&](auto& list) {
      using Object = typename std::remove_reference_t<decltype(list)>::value_type;
      list.at(ref.index) = std::get<Object>(std::move(object));
    });
  });
}

void SceneEditor::set_tip_radius(double radius) {
  change("tip radius",
         [&](World& world) { world.document.scene.tip_radius = kRadius.hold(radius, 0); });
}

void SceneEditor::add(MeshObstacle mesh, ModelFile file, std::shared_ptr<const Model> model) {
  const std::map<std::string, ModelFile>& known = document().models;
  const std::filesystem::path wanted = mesh.model;
  for (int i = 2; known.contains(mesh.model) && *known.at(mesh.model).bytes != *file.bytes; ++i) {
    const std::string number = fmt::format("{}-{}", wanted.stem().string(), i);
    mesh.model = wanted.parent_path() / (number + wanted.extension().string());
  }
  insert(std::move(mesh), std::move(model), &file);
}

void SceneEditor::insert(SceneObject object, std::shared_ptr<const Model> model,
                         const ModelFile* file) {
  if (objects_of(scene()).size() >= kMostContacts) {
    throw std::runtime_error(
        fmt::format("A scene holds at most {} objects; remove one first.", kMostContacts));
  }
  std::visit(
      [&](auto& o) {
        hold(o);
        o.name = free_name(o.name, std::nullopt);
      },
      object);
  const auto kind = static_cast<ObjectKind>(object.index());
  const std::size_t index = count(scene(), kind);
  change("", [&](World& world) {
    if (kind == ObjectKind::mesh) world.models.push_back(std::move(model));
    if (file != nullptr) world.document.models[std::get<MeshObstacle>(object).model] = *file;
    with_list(world.document.scene, kind, [&](auto& list) {
      using Object = typename std::remove_reference_t<decltype(list)>::value_type;
      list.push_back(std::get<Object>(std::move(object)));
    });
  });
  now_.selected = ObjectRef{kind, index};
}

void SceneEditor::duplicate(const ObjectRef& ref) {
  SceneObject copy = object_of(scene(), ref);
  const auto model = ref.kind == ObjectKind::mesh ? models().at(ref.index) : nullptr;
  const Eigen::AlignedBox3d box = bounds_of(copy, model.get());
  move_aside(copy, box.isEmpty() ? 0.02 : 1.1 * box.sizes().y());
  insert(std::move(copy), model);
}

void SceneEditor::rename(const ObjectRef& ref, const std::string& name) {
  if (name.empty() || name == name_of(scene(), ref)) return;
  const std::string wanted = free_name(name, ref);
  change("", [&](World& world) {
    with_list(world.document.scene, ref.kind,
              [&](auto& list) { list.at(ref.index).name = wanted; });
  });
}

void SceneEditor::remove(const ObjectRef& ref) {
  const auto at = static_cast<std::ptrdiff_t>(ref.index);
  change("", [&](World& world) {
    if (ref.kind == ObjectKind::mesh) world.models.erase(world.models.begin() + at);
    with_list(world.document.scene, ref.kind, [&](auto& list) { list.erase(list.begin() + at); });
    std::erase_if(world.document.models, [&](const auto& known) {
      return std::ranges::find(world.document.scene.meshes, known.first, &MeshObstacle::model) ==
             world.document.scene.meshes.end();
    });
  });
  now_.selected.reset();
}

std::string SceneEditor::free_name(const std::string& wanted,
                                   const std::optional<ObjectRef>& except) const {
  const auto taken = [&](const std::string& candidate) {
    return std::ranges::any_of(objects_of(scene()), [&](const ObjectRef& ref) {
      return ref != except && name_of(scene(), ref) == candidate;
    });
  };
  if (!wanted.empty() && !taken(wanted)) return wanted;
  // "gear 2" is followed by "gear 3".
  std::string stem = wanted.empty() ? "object" : wanted;
  const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
  if (digits > 1 && digits < stem.size() && stem[digits - 1] == ' ') stem.resize(digits - 1);
  for (int i = 2;; ++i) {
    if (const std::string name = fmt::format("{} {}", stem, i); !taken(name)) return name;
  }
}

}  // namespace limpid
