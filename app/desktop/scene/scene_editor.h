// Editor of the scene that is worked on, with every way to change it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/run/scene_meshes.h"
#include "devices/files/scene/scene_document.h"
#include "render/camera.h"

namespace limpid {

// Returns the room that an object takes [m]; empty for planes, stops of joints and meshes without a
// model.
Bounds bounds_of(const Object& object, const Model* model);

struct Ball {
  Vec3 middle;
  double radius;  // [m]
};
// Returns the ball around an object's bounds, or around the triangles of its mesh.
std::optional<Ball> ball_around(const Object& object);

// Changes the scene. Keeps numbers within the limits of a scene's file, and rotations at those that
// a file says exactly.
class SceneEditor {
 public:
  // Scene at one time. Versions share their equal parts; equal pointers: nothing changed.
  struct World {
    SceneDocument document;
    MeshModels models;  // as many as objects
  };
  struct Version {
    std::shared_ptr<const World> world = std::make_shared<const World>();
    std::optional<std::size_t> selected;  // place of the selected object
  };

  // Opens another scene, as its file has it; not `saved`: no file has it yet.
  void open(SceneDocument document, MeshModels models, bool saved = true);

  const SceneDocument& document() const { return now_.world->document; }
  const Scene& scene() const { return document().scene; }
  const MeshModels& models() const { return now_.world->models; }
  const Version& version() const { return now_; }
  void restore(const Version& version);  // an earlier one
  // Returns the name of the last change for UndoHistory; empty: a step of its own.
  const std::string& last_change() const { return last_change_; }
  bool dirty() const { return now_.world != saved_; }

  const std::optional<std::size_t>& selected() const { return now_.selected; }
  const Object* selected_object() const {  // null: none
    return now_.selected ? &scene().objects[*now_.selected] : nullptr;
  }
  void select(std::optional<std::size_t> place) { now_.selected = place; }
  // Selects the object that is `step` places further in the list.
  void select_next(int step);

  // Replaces an object by one of the same shape; `what` names the number that was changed. An
  // object that begins or ceases to move gets another place and is selected there.
  void set(std::size_t place, Object object, const std::string& what);
  void set_tip_radius(double radius);
  // Adds and selects an object, as the other add() and duplicate() do. A name that is taken gets a
  // number. Errors: std::runtime_error if the scene is full.
  void add(Object object) { insert(std::move(object), nullptr); }
  // Adds a mesh with its model. The model's name gets a number, too, if another file already has
  // it.
  void add(Object mesh, ModelFile file, std::shared_ptr<const Model> model);
  void duplicate(std::size_t place);
  void rename(std::size_t place, const std::string& name);
  // Removes an object and its springs; joints to it then hold to the world. Returns sentences on
  // both; mostly empty.
  std::string remove(std::size_t place);

  void set_gravity(const Vec3& gravity);
  void add_spring(BodySpring spring);
  void set_spring(std::size_t place, BodySpring spring, const std::string& what);
  void remove_spring(std::size_t place);

  // Notes that the scene was written, and takes over the scene as written.
  void saved(SceneDocument document);

 private:
  void insert(Object object, std::shared_ptr<const Model> model, const ModelFile* file = nullptr);
  template <class Change>
  void change(std::string what, Change&& change);
  std::string free_name(const std::string& wanted, std::optional<std::size_t> except) const;

  Version now_;
  std::shared_ptr<const World> saved_ = now_.world;
  std::string last_change_;
};

}  // namespace limpid
