// The 3D picture: arm, proxy, scene, hand, contacts and forces, from one frame's plain data.
//
// Needs a current OpenGL 3.3 core context from construction to destruction, always the same one.
#pragma once

#include <filesystem>
#include <memory>

#include "core/dynamics/arm_description.h"
#include "core/dynamics/scene.h"
#include "render/camera.h"
#include "render/quality.h"
#include "render/view_state.h"

namespace limpid {

class SceneView {
 public:
  // Loads the shaders, every visual of the arm and of the scene. An arm without visuals is drawn
  // as capsules from joint to joint. Throws std::runtime_error naming the file (and line of a
  // shader) that is missing or wrong. Chooses the quality that suits GL_RENDERER.
  SceneView(const std::filesystem::path& shaders, const ArmDescription& arm, const Scene& scene);
  ~SceneView();
  SceneView(SceneView&&) noexcept;
  SceneView& operator=(SceneView&&) noexcept;

  // Draws into a rectangle of the bound framebuffer, in its pixels, y up from the bottom as
  // OpenGL counts. Leaves that framebuffer and its viewport as they were, and no state behind
  // that blends, tests, culls or clips.
  void draw(const ViewState& state, const Camera& camera, int x, int y, int width, int height);

  // What a camera should frame: the arm, the room it works in and what can be touched there [m].
  const Bounds& bounds() const;
  // Where the floor grid is, a flat box [m]; its lines are at multiples of 5 cm, the stronger ones
  // at multiples of 10 cm.
  const Bounds& grid() const;

  const Quality& quality() const;
  void set_quality(const Quality& quality);

  // Lines and marks grow with this; 2 on a screen with twice the pixels. 1 to begin with.
  void set_pixel_scale(double scale);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace limpid
