// Items to draw for an arm and a scene, as meshes fixed to links.
#pragma once

#include <span>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "core/touch/scene.h"
#include "render/camera.h"
#include "render/model/model.h"
#include "render/view_state.h"

namespace limpid {

struct Item {
  Model model;
  Pose pose = Pose::Identity();  // in the frame of `link`
  int link = -1;                 // -1 the base, which is the world
  bool own_color = false;        // keeps its colour; else one that suits the theme
};

struct SceneItems {
  std::vector<Item> base;    // of the arm, does not move
  std::vector<Item> moving;  // of the arm
  std::vector<Item> world;   // objects that can be touched, solid
  std::vector<Item> bodies;  // touchable objects that move; `link` is the body's number
  std::vector<Pose> starts;  // of each body, where the scene has it
  std::vector<Item> walls;   // stops of joints, translucent; `link` is the one before the joint
  std::vector<Item> probes;  // parts of the arm that touch, translucent
  Bounds arm_bounds;         // of the arm at rest and the room in front of it [m]
  double reach = 0;          // of the arm [m]
  std::vector<double> level_planes;  // heights of level planes that can be touched [m]
};

// Collects the items of an arm and a scene. Throws std::runtime_error naming the scene's file that
// cannot be loaded.
SceneItems collect_items(const ArmDescription& arm, const Scene& scene,
                         std::span<const VisualPicture> visuals);
// Replaces the scene's items; `items` came from this arm.
void collect_scene_items(const ArmDescription& arm, const Scene& scene,
                         std::span<const VisualPicture> visuals, SceneItems& items);

// Bounds, ground and grid of all that is drawn together.
struct Surroundings {
  Bounds bounds;      // to be framed by a camera [m]
  double ground = 0;  // height of the floor under everything [m]
  Bounds grid;        // floor grid, flat [m]
};

// Finds the surroundings; `meshes` are boxes of what is drawn besides the items.
Surroundings surroundings_of(const SceneItems& items, const std::vector<Bounds>& meshes);

Bounds moved(const Bounds& box, const Eigen::Affine3d& by);

}  // namespace limpid
