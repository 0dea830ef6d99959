// Scenes' models and rows of the trace as the 3D view shows them.
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "app/run/scene_meshes.h"
#include "core/dynamics/arm.h"
#include "core/tick/row.h"
#include "core/touch/scene.h"
#include "devices/files/scene/scene_document.h"
#include "devices/simulated/rig.h"
#include "render/scene_view.h"
#include "render/view_state.h"

namespace limpid {

inline std::vector<MeshPicture> mesh_pictures(const Scene& scene, const MeshModels& models,
                                              std::optional<std::size_t> highlighted = {}) {
  std::vector<MeshPicture> pictures;
  int bodies = 0;
  for (std::size_t i = 0; i < std::min(scene.objects.size(), models.size()); ++i) {
    const Object& object = scene.objects[i];
    const int body = object.body ? bodies++ : -1;
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh == nullptr) continue;
    const Pose pose = mesh->stood(object.body ? Pose::Identity() : object.pose);
    pictures.push_back({models[i], pose, mesh->size(), highlighted == i, body});
  }
  return pictures;
}

inline std::vector<VisualPicture> visual_pictures(const SceneDocument& document) {
  std::vector<VisualPicture> pictures;
  for (const SceneVisual& visual : document.visuals) {
    pictures.push_back({visual.file, visual.pose, usual_unit(visual.file) * visual.scale});
  }
  return pictures;
}

// Makes the 3D view's state from rows of the trace.
class RowView {
 public:
  explicit RowView(const ArmDescription& arm, const Scene& scene = {});

  // Takes over another scene: the centres of mass of its bodies.
  void show(const Scene& scene);

  ArmPose pose(std::span<const double> x) const;
  Vec3 tip(std::span<const double> x) const;
  // Returns the force at the tip that fits the joints' torque, by least squares [N].
  Vec3 tip_force(std::span<const double> x, std::span<const double> torque) const;
  // Returns the contacts of the proxy. If a recording has only their torque, returns it as one
  // force at the tip.
  std::vector<ContactForce> contacts(const RowLayout& layout, std::span<const double> row) const;
  // Returns the frames of the scene's moving objects, as many as both row and scene have.
  std::vector<Pose> bodies(const RowLayout& layout, std::span<const double> row) const;
  // Returns both arms, the hand with its force and its tool, and the moving objects; no contacts,
  // no trails.
  ViewState view(const RowLayout& layout, std::span<const double> row) const;

 private:
  Arm<kAnyDof> arm_;
  std::vector<Vec3> centers_;  // of mass of each body, in the body's frame [m]
};

// Puts a further run's view into the first one's picture.
void lay_over(ViewState& view, const ViewState& other);

// Remembers when each contact began and where the tips were in the last second.
class ViewMemory {
 public:
  void clear();
  void update(ViewState& view, std::span<const ContactForce> contacts, double time);

 private:
  struct Touch {
    Vec3 point;
    double began;
    double seen;
  };
  struct Tips {
    double time;
    Vec3 device, proxy;
  };
  std::vector<Touch> touches_;
  std::deque<Tips> tips_;
};

}  // namespace limpid
