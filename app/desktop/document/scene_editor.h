// The scene that is being worked on, and every way to change it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/run/scene_meshes.h"
#include "devices/files/scene/scene_document.h"

namespace limpid {

enum class ObjectKind : std::uint8_t { plane, sphere, box, mesh, joint_contact };

// Which object of a scene: its place among those of its kind.
struct ObjectRef {
  ObjectKind kind = ObjectKind::plane;
  std::size_t index = 0;
  friend bool operator==(const ObjectRef&, const ObjectRef&) = default;
};

// In the order of ObjectKind.
using SceneObject = std::variant<Plane, Sphere, Box, MeshObstacle, JointContact>;

std::vector<ObjectRef> objects_of(const Scene& scene);
SceneObject object_of(const Scene& scene, const ObjectRef& ref);  // precondition: it is there
const std::string& name_of(const Scene& scene, const ObjectRef& ref);
const char* kind_name(ObjectKind kind);
// What it takes of the world [m]; empty for planes and joint contacts.
Eigen::AlignedBox3d bounds_of(const SceneObject& object, const Model* model);

// Numbers are held within what a scene's file may say, rotations at those it says exactly.
class SceneEditor {
 public:
  // A scene at one time. Versions share what they have in common; equal pointers: nothing changed.
  struct World {
    SceneDocument document;
    MeshModels models;  // of the scene's meshes, in their order
  };
  struct Version {
    std::shared_ptr<const World> world = std::make_shared<const World>();
    std::optional<ObjectRef> selected;
  };

  // Another scene, as its file has it; not `saved`: no file has it yet.
  void open(SceneDocument document, MeshModels models, bool saved = true);

  const SceneDocument& document() const { return now_.world->document; }
  const Scene& scene() const { return document().scene; }
  const MeshModels& models() const { return now_.world->models; }
  const Version& version() const { return now_; }
  void restore(const Version& version);  // an earlier one
  // Names the last change for UndoHistory; empty: a step of its own.
  const std::string& last_change() const { return last_change_; }
  bool dirty() const { return now_.world != saved_; }

  const std::optional<ObjectRef>& selected() const { return now_.selected; }
  void select(std::optional<ObjectRef> ref) { now_.selected = ref; }
  // One further in the list, or back.
  void select_next(int step);

  // Replaces an object by one of the same kind; `what` names the number that was changed.
  void set(const ObjectRef& ref, SceneObject object, const std::string& what);
  void set_tip_radius(double radius);
  // The name gets a number where another object has it already. All select what they made. Errors:
  // std::runtime_error if the scene is full.
  void add(SceneObject object) { insert(std::move(object), nullptr); }
  // A mesh with its model. That gets a number, too, where its file was another one earlier.
  void add(MeshObstacle mesh, ModelFile file, std::shared_ptr<const Model> model);
  void duplicate(const ObjectRef& ref);
  void rename(const ObjectRef& ref, const std::string& name);
  void remove(const ObjectRef& ref);

  // The scene was written, and has become this one by that.
  void saved(SceneDocument document);

 private:
  void insert(SceneObject object, std::shared_ptr<const Model> model,
              const ModelFile* file = nullptr);
  template <class Change>
  void change(std::string what, Change&& change);
  std::string free_name(const std::string& wanted, const std::optional<ObjectRef>& except) const;

  Version now_;
  std::shared_ptr<const World> saved_ = now_.world;
  std::string last_change_;
};

}  // namespace limpid
