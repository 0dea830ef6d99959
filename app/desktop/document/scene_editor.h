// The scene that is being worked on, and every way to change it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/run/scene_meshes.h"
#include "devices/files/scene/scene_document.h"
#include "render/camera.h"

namespace limpid {

// What it takes of the world [m]; empty for planes, stops of joints and meshes without a model.
Bounds bounds_of(const Object& object, const Model* model);

// Numbers are held within what a scene's file may say, rotations at those it says exactly.
class SceneEditor {
 public:
  // A scene at one time. Versions share what they have in common; equal pointers: nothing changed.
  struct World {
    SceneDocument document;
    MeshModels models;  // as many as objects
  };
  struct Version {
    std::shared_ptr<const World> world = std::make_shared<const World>();
    std::optional<std::size_t> selected;  // its place among the objects
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

  const std::optional<std::size_t>& selected() const { return now_.selected; }
  const Object* selected_object() const {  // null: none
    return now_.selected ? &scene().objects[*now_.selected] : nullptr;
  }
  void select(std::optional<std::size_t> place) { now_.selected = place; }
  // One further in the list, or back.
  void select_next(int step);

  // Replaces the object at a place by one of the same shape; `what` names the number that was
  // changed. One that begins to move, or no longer does, gets another place and is selected there.
  void set(std::size_t place, Object object, const std::string& what);
  void set_tip_radius(double radius);
  // The name gets a number where another object has it already. All select what they made. Errors:
  // std::runtime_error if the scene is full.
  void add(Object object) { insert(std::move(object), nullptr); }
  // A mesh with its model. That gets a number, too, where its file was another one earlier.
  void add(Object mesh, ModelFile file, std::shared_ptr<const Model> model);
  void duplicate(std::size_t place);
  void rename(std::size_t place, const std::string& name);
  // Joints to it then hold to the world, and its springs go. What did, for people; mostly nothing.
  std::string remove(std::size_t place);

  void set_gravity(const Vec3& gravity);
  void add_spring(BodySpring spring);
  void set_spring(std::size_t place, BodySpring spring, const std::string& what);
  void remove_spring(std::size_t place);

  // The scene was written, and has become this one by that.
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
