// The passes a frame is made of. All their data are on the graphics card already.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "render/camera.h"
#include "render/damage.h"
#include "render/gl/gpu_model.h"
#include "render/gl/line_batch.h"
#include "render/gl/shader_program.h"
#include "render/lit_pass.h"
#include "render/marks.h"
#include "render/palette.h"
#include "render/quality.h"
#include "render/scene_items.h"

namespace limpid {

// Unit vector towards the key light.
inline const glm::vec3 kToLight = glm::normalize(glm::vec3(-0.30f, -0.55f, 1.0f));

struct PlacedMesh {
  std::shared_ptr<const Model> model;
  glm::mat4 pose;
  bool highlighted;
  int body;  // body whose frame it is in; -1: the world
};

class ScenePainter {
 public:
  ScenePainter(const std::filesystem::path& shaders, const SceneItems& items,
               const Surroundings& around);

  void set_scene_items(const SceneItems& items);  // all but the arm
  void set_meshes(const std::vector<PlacedMesh>& meshes);
  void set_surroundings(const Surroundings& around);

  // Sets what all passes share: camera, light, colours. Comes before all passes.
  void begin_frame(const Lighting& lighting, const Camera& camera);
  // Names the parts of the arm that may look different from frame to frame; `casts`: with its
  // shadow.
  void note(const Links& links, bool casts, Damage& damage) const;
  void note(const Ghost& ghost, Damage& damage) const;
  void note_bodies(const Links& bodies, Damage& damage) const;  // with their shadows
  void note(const BodyGhosts& ghosts, Damage& damage) const;
  void note(const Marks& marks, Damage& damage) const;
  void note(const LineBatch& lines, Damage& damage) const;
  // Limits drawing to `area` from now on; what lies beside it is left out where that is cheap.
  void limit(const PixelArea& area, const PixelArea& whole) {
    seen_ = cropped(view_, area, whole);
    pixels_ = static_cast<float>(area.sizes().prod());
  }
  void draw_shadows(const Links& proxy, const Links& bodies);
  // Draws proxy, base, scene, ground and backdrop.
  void draw_solid(const Lighting& lighting, const Links& proxy, const Links& bodies);
  // Draws a ghost's outermost surface; `number` tells the ghosts of a picture apart, from 0 on.
  void draw_ghost(const Ghost& ghost, std::size_t number);
  // Comes before any ghost.
  void draw_shades(const Marks& marks) const;
  // Draws stops of joints and the arm's touching parts.
  void draw_glass(const Links& proxy);
  void draw_body_ghosts(const BodyGhosts& ghosts);
  void draw_marks(const Marks& marks);
  // Draws lines that nearer things hide, or that are on top of everything.
  void draw_lines(LineBatch& lines, bool on_top);

  const Quality& quality() const { return quality_; }
  void set_quality(const Quality& quality);
  double pixel_scale() const { return pixel_scale_; }
  void set_pixel_scale(double scale) { pixel_scale_ = static_cast<float>(scale); }

 private:
  bool too_many_triangles() const;
  void draw_still_shadows() const;
  void draw_outlines(const Lighting& lighting, const Links& bodies) const;
  void add_to(Damage& damage, const GpuModel& model, const glm::mat4& pose, bool shadow) const;
  void draw_translucent(const ShaderProgram& program, const std::vector<Drawable>& list,
                        const Links& links, const palette::Rgb& color, glm::vec2 alpha) const;
  void draw_ghost_outline(const Ghost& ghost, int mark) const;
  void draw_ground() const;
  void draw_solid_marks(const std::vector<SolidMark>& marks, glm::vec2 alpha) const;

  std::filesystem::path shaders_;
  Quality quality_;
  ShaderProgram depth_only_, ghost_depth_, ghost_, flash_, line_, backdrop_, outline_, shade_;
  std::unique_ptr<LitPass> lit_;
  GlBuffer frame_block_;
  GlVertexArray no_vertices_;
  GpuModel ball_, cone_, tube_, patch_;
  std::vector<Drawable> base_, moving_, world_, walls_, probes_, meshes_;
  std::vector<Drawable> bodies_, body_meshes_;  // `link` is the body's number
  std::vector<Drawable> highlighted_;           // some of meshes_ and body_meshes_
  // Uploaded models of meshes_; the keys keep the models' addresses from being used again.
  std::map<std::shared_ptr<const Model>, std::shared_ptr<const GpuModel>> uploaded_;
  Bounds bounds_;
  glm::mat4 view_{1.0f};        // world to clip space
  glm::mat4 seen_{1.0f};        // view_, cropped to the area drawn in this frame
  Damage shadow_damage_;        // in the shadow map
  bool still_shadows_ = false;  // the map holds the shadows of what does not move
  float ground_height_ = 0, pixel_scale_ = 1, pixels_ = 1;
  bool textured_world_ = false, coarse_ = false;
};

}  // namespace limpid
