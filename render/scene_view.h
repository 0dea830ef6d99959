// The 3D picture: arm, proxy, scene, hand, contacts and forces, from one frame's plain data.
//
// Needs a current OpenGL 3.3 core context from construction to destruction, always the same one.
//
//   SceneView view(shaders, arm, scene, visuals);
//   view.set_scene(other_scene, its_visuals);       // the arm and the shaders stay
//   auto bunny = std::make_shared<const Model>(load_gltf("bunny.glb"));   // on any thread
//   view.set_meshes(std::vector<MeshPicture>{{.model = bunny, .pose = pose, .scale = 0.1}});
//   view.draw(state, camera, 0, 0, width, height);
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "core/base/lanes.h"
#include "core/dynamics/arm_description.h"
#include "core/touch/scene.h"
#include "render/camera.h"
#include "render/model/model.h"
#include "render/quality.h"
#include "render/view_state.h"

namespace limpid {

// A model in the world, or in the frame of the scene's body of that number: a vertex v appears at
// pose * (scale * v) there.
struct MeshPicture {
  std::shared_ptr<const Model> model;
  Pose pose = Pose::Identity();
  double scale = 1;          // above 0
  bool highlighted = false;  // an outline, for what is selected
  int body = -1;             // -1: the world
};

class SceneView {
 public:
  // Number of a picture where one frame has several: each remembers how it was drawn the last time.
  // A lens is what Camera::magnified() sees; small is kept as a file; beside and those behind it
  // are the arms of further lanes in the same scene.
  enum class Sheet { main, lens, small, beside };
  static Sheet sheet_of(std::size_t lane) {
    if (lane == kMainLane) return Sheet::main;
    return static_cast<Sheet>(static_cast<std::size_t>(Sheet::beside) + lane - 1);
  }

  // Loads the shaders, every visual of the arm and these of the scene. An arm without visuals is
  // drawn as capsules from joint to joint. Throws std::runtime_error naming the file (and line of a
  // shader) that is missing or wrong. Chooses the quality that suits GL_RENDERER.
  SceneView(const std::filesystem::path& shaders, const ArmDescription& arm, const Scene& scene,
            std::span<const VisualPicture> visuals);
  ~SceneView();
  SceneView(SceneView&&) noexcept;
  SceneView& operator=(SceneView&&) noexcept;

  // Replaces the scene around the same arm: what can be touched, seen and stopped at. The meshes of
  // set_meshes stay. Throws as the constructor does, and leaves everything as it was then.
  void set_scene(const Scene& scene, std::span<const VisualPicture> visuals);

  // Replaces the meshes drawn besides the scene's own items. A model is uploaded once for as long
  // as it stays in the list, however often it is in it; a null model is left out. Cheap when only
  // poses and highlights change, so it may be called every frame.
  void set_meshes(std::span<const MeshPicture> meshes);

  // Draws into a rectangle of the bound framebuffer, in its pixels, y up from the bottom as OpenGL
  // counts. Leaves that framebuffer and its viewport as they were, and no state behind that blends,
  // tests, culls or clips. Draws anew only what looks different than in the frame before; returns
  // false if nothing does.
  bool draw(const ViewState& state, const Camera& camera, int x, int y, int width, int height,
            Sheet on = Sheet::main);
  // Returns whether draw() would show anything new in a viewport as large as the camera's; a tenth
  // of a pixel does not count.
  bool differs(const ViewState& state, const Camera& camera, Sheet on = Sheet::main) const;

  // Returns what a camera should frame [m]: the arm, the room it works in and what can be touched
  // there, meshes as far as they are within reach.
  const Bounds& bounds() const;
  // Returns the floor grid's place, a flat box [m]; its lines are at multiples of 5 cm, the
  // stronger ones at multiples of 10 cm.
  const Bounds& grid() const;

  const Quality& quality() const;
  void set_quality(const Quality& quality);

  // Scales lines and marks; 2 on a screen with twice the pixels. 1 to begin with.
  void set_pixel_scale(double scale);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace limpid
