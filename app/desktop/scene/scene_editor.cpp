#include "app/desktop/scene/scene_editor.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "core/touch/triangle_mesh.h"
#include "devices/files/rpy.h"
#include "devices/files/scene/body_file.h"
#include "devices/files/scene/scene_document.h"
#include "devices/files/scene/scene_file.h"
#include "render/scene_items.h"

namespace limpid {
namespace {

using namespace scene_limits;

Bounds bounds(const Plane&, const Pose&, const Model*) { return {}; }
Bounds bounds(const JointStop&, const Pose&, const Model*) { return {}; }
Bounds bounds(const Sphere& sphere, const Pose& pose, const Model*) {
  const Vec3 r = Vec3::Constant(sphere.radius);
  return {pose.translation() - r, pose.translation() + r};
}
Bounds bounds(const Box& box, const Pose& pose, const Model*) {
  return moved(Bounds(Vec3(-box.size / 2), Vec3(box.size / 2)), pose);
}
Bounds bounds(const Cylinder& cylinder, const Pose& pose, const Model*) {
  // The rim of a disc reaches along a world axis as far as the axis lies in the disc's plane.
  const Vec3 axis = pose.linear().col(2);
  const Vec3 half = cylinder.length / 2 * axis.cwiseAbs() +
                    cylinder.radius * (1 - axis.array().square()).max(0).sqrt().matrix();
  return {pose.translation() - half, pose.translation() + half};
}
Bounds bounds(const Capsule& capsule, const Pose& pose, const Model*) {
  const Vec3 half =
      capsule.length / 2 * pose.linear().col(2).cwiseAbs() + Vec3::Constant(capsule.radius);
  return {pose.translation() - half, pose.translation() + half};
}
Bounds bounds(const Mesh& mesh, const Pose& pose, const Model* model) {
  if (model == nullptr) return {};
  return moved(model->bounds(), Eigen::Affine3d(mesh.stood(pose)) * Eigen::Scaling(mesh.size()));
}

// Frees joints and springs from the body `name`. Returns sentences on them.
std::string let_go(Scene& scene, const std::string& name) {
  std::string said;
  for (Object& object : scene.objects) {
    if (!object.body || !object.body->joint || object.body->joint->to != name) continue;
    object.body->joint->to.clear();
    said += fmt::format("The joint of {} now connects to the world. ", object.name);
  }
  const auto springs = std::erase_if(scene.springs, [&](const BodySpring& spring) {
    return spring.between[0] == name || spring.between[1] == name;
  });
  if (springs == 1) said += "The object's spring was removed, too. ";
  if (springs > 1) said += fmt::format("The object's {} springs were removed, too. ", springs);
  return said;
}

}  // namespace

Bounds bounds_of(const Object& object, const Model* model) {
  Bounds all = std::visit([&](const auto& shape) { return bounds(shape, object.pose, model); },
                          object.shape);
  for (const BodyPart& part : object.parts) {
    const Pose pose = object.pose * part.pose;
    all.extend(
        std::visit([&](const auto& shape) { return bounds(shape, pose, nullptr); }, part.shape));
  }
  return all;
}

std::optional<Ball> ball_around(const Object& object) {
  const Mesh* const mesh = std::get_if<Mesh>(&object.shape);
  if (mesh != nullptr && mesh->triangles) {
    const Vec3 middle = mesh->size() * mesh->triangles->middle();
    return Ball{mesh->stood(object.pose) * middle, mesh->size() * mesh->triangles->radius()};
  }
  const Bounds box = bounds_of(object, nullptr);
  if (box.isEmpty()) return std::nullopt;
  return Ball{box.center(), 0.5 * box.diagonal().norm()};
}

void SceneEditor::open(SceneDocument document, MeshModels models, bool saved) {
  models.resize(document.scene.objects.size());
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
  // The text is out of date; rotations are settled at those that a new text can say.
  next.document.toml.clear();
  for (Object& object : next.document.scene.objects) {
    object.pose.linear() = settled(object.pose.linear());
  }
  now_.world = std::make_shared<const World>(std::move(next));
  last_change_ = std::move(what);
}

void SceneEditor::select_next(int step) {
  const auto size = static_cast<int>(scene().objects.size());
  if (size == 0) return;
  const int none = step > 0 ? -1 : size;
  const int at = now_.selected ? static_cast<int>(*now_.selected) : none;
  now_.selected = static_cast<std::size_t>(((at + step) % size + size) % size);
}

void SceneEditor::set(std::size_t place, Object object, const std::string& what) {
  hold(object);
  const bool moves = object.body.has_value();
  if (moves && object.body->joint && object.body->joint->to == object.name) {
    object.body->joint->to.clear();
  }
  if (moves == scene().objects.at(place).body.has_value()) {
    change(fmt::format("{} {}", place, what),
           [&](World& world) { world.document.scene.objects.at(place) = std::move(object); });
    return;
  }
  if (moves) object.name = free_name(object.name, place);
  if (!moves) object.parts.clear();
  std::size_t there = 0;
  change("", [&](World& world) {
    Scene& scene = world.document.scene;
    if (!moves) let_go(scene, object.name);
    const auto from = static_cast<std::ptrdiff_t>(place);
    const auto model = world.models[place];
    scene.objects.erase(scene.objects.begin() + from);
    world.models.erase(world.models.begin() + from);
    there = scene.add(std::move(object));
    world.models.insert(world.models.begin() + static_cast<std::ptrdiff_t>(there), model);
  });
  now_.selected = there;
}

void SceneEditor::set_gravity(const Vec3& gravity) {
  change("gravity", [&](World& world) {
    for (int i = 0; i < 3; ++i) {
      world.document.scene.gravity[i] = kGravity.hold(gravity[i], 0);
    }
  });
}

void SceneEditor::add_spring(BodySpring spring) {
  if (scene().springs.size() >= kMostSprings) {
    throw std::runtime_error(
        fmt::format("A scene holds at most {} springs; remove a spring first.", kMostSprings));
  }
  hold(spring);
  change("", [&](World& world) { world.document.scene.springs.push_back(std::move(spring)); });
}

void SceneEditor::set_spring(std::size_t place, BodySpring spring, const std::string& what) {
  hold(spring);
  change(fmt::format("spring {} {}", place, what),
         [&](World& world) { world.document.scene.springs.at(place) = std::move(spring); });
}

void SceneEditor::remove_spring(std::size_t place) {
  change("", [&](World& world) {
    std::vector<BodySpring>& springs = world.document.scene.springs;
    springs.erase(springs.begin() + static_cast<std::ptrdiff_t>(place));
  });
}

void SceneEditor::set_tip_radius(double radius) {
  change("tip radius",
         [&](World& world) { world.document.scene.tip_radius = kRadius.hold(radius, 0); });
}

void SceneEditor::add(Object object, ModelFile file, std::shared_ptr<const Model> model) {
  const std::map<std::string, ModelFile>& known = document().models;
  std::string& name = std::get<Mesh>(object.shape).model;
  const std::filesystem::path wanted = name;
  for (int i = 2; known.contains(name) && *known.at(name).bytes != *file.bytes; ++i) {
    const std::string number = fmt::format("{}-{}", wanted.stem().string(), i);
    name = wanted.parent_path() / (number + wanted.extension().string());
  }
  insert(std::move(object), std::move(model), &file);
}

void SceneEditor::insert(Object object, std::shared_ptr<const Model> model, const ModelFile* file) {
  if (scene().objects.size() >= kMostContacts) {
    throw std::runtime_error(
        fmt::format("A scene holds at most {} objects; remove an object first.", kMostContacts));
  }
  hold(object);
  object.name = free_name(object.name, std::nullopt);
  std::size_t place = 0;
  change("", [&](World& world) {
    if (file != nullptr) world.document.models[std::get<Mesh>(object.shape).model] = *file;
    place = world.document.scene.add(std::move(object));
    world.models.insert(world.models.begin() + static_cast<std::ptrdiff_t>(place),
                        std::move(model));
  });
  now_.selected = place;
}

void SceneEditor::duplicate(std::size_t place) {
  Object copy = scene().objects.at(place);
  const auto model = models()[place];
  // The copy is a little beside the original, to be seen.
  if (const auto* plane = std::get_if<Plane>(&copy.shape)) {
    copy.pose.translation() += 0.02 * plane->normal;
  } else if (const Bounds box = bounds_of(copy, model.get()); !box.isEmpty()) {
    copy.pose.translation().y() += 1.1 * box.sizes().y();
  }
  insert(std::move(copy), model);
}

void SceneEditor::rename(std::size_t place, const std::string& name) {
  if (name.empty() || name == scene().objects.at(place).name) return;
  const std::string wanted = free_name(name, place);
  change("", [&](World& world) {
    Scene& scene = world.document.scene;
    const std::string before = std::exchange(scene.objects[place].name, wanted);
    if (!scene.objects[place].body) return;
    for (Object& object : scene.objects) {
      if (object.body && object.body->joint && object.body->joint->to == before) {
        object.body->joint->to = wanted;
      }
    }
    for (BodySpring& spring : scene.springs) std::ranges::replace(spring.between, before, wanted);
  });
}

std::string SceneEditor::remove(std::size_t place) {
  const auto at = static_cast<std::ptrdiff_t>(place);
  std::string said;
  change("", [&](World& world) {
    std::vector<Object>& objects = world.document.scene.objects;
    if (objects[place].body) said = let_go(world.document.scene, objects[place].name);
    world.models.erase(world.models.begin() + at);
    objects.erase(objects.begin() + at);
    std::erase_if(world.document.models, [&](const auto& known) {
      return std::ranges::none_of(objects, [&](const Object& object) {
        const auto* mesh = std::get_if<Mesh>(&object.shape);
        return mesh != nullptr && mesh->model == known.first;
      });
    });
  });
  now_.selected.reset();
  return said;
}

std::string SceneEditor::free_name(const std::string& wanted,
                                   std::optional<std::size_t> except) const {
  const auto taken = [&](const std::string& candidate) {
    const std::vector<Object>& objects = scene().objects;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      if (i != except && objects[i].name == candidate) return true;
    }
    return false;
  };
  if (!wanted.empty() && !taken(wanted)) return wanted;
  // The name after "gear 2" is "gear 3".
  std::string stem = wanted.empty() ? "object" : wanted;
  const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
  if (digits > 1 && digits < stem.size() && stem[digits - 1] == ' ') stem.resize(digits - 1);
  for (int i = 2;; ++i) {
    if (const std::string name = fmt::format("{} {}", stem, i); !taken(name)) return name;
  }
}

}  // namespace limpid
