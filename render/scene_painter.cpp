#include "render/scene_painter.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "render/frustum.h"
#include "render/gl/glm_door.h"
#include "render/mesh_shapes.h"

namespace limpid {
namespace {

// The uniform block of common.glsl, std140.
struct FrameBlock {
  glm::mat4 view_projection, light_projection;
  glm::vec4 eye, to_light, key, sky, earth, ground, top, bottom, view;
};

glm::vec4 linear(const palette::Rgb& c, float amount) {
  return {std::pow(c[0], 2.2f), std::pow(c[1], 2.2f), std::pow(c[2], 2.2f), amount};
}

glm::vec4 srgb(const palette::Rgb& c) { return {c[0], c[1], c[2], 1}; }

std::vector<Drawable> upload_all(const std::vector<Item>& items) {
  std::vector<Drawable> out;
  for (const Item& item : items)
    out.push_back({std::make_shared<const GpuModel>(item.model), to_glm(item.pose), item.link});
  return out;
}

std::string renderer_name() {
  const GLubyte* name = glGetString(GL_RENDERER);
  return name ? reinterpret_cast<const char*>(name) : "";
}

}  // namespace

ScenePainter::ScenePainter(const std::filesystem::path& shaders, const SceneItems& items,
                           const Surroundings& around)
    : shaders_(shaders),
      quality_(Quality::automatic(renderer_name())),
      depth_only_(shaders, "shadow", "shadow"),
      ghost_depth_(shaders, "ghost", "shadow"),
      ghost_(shaders, "ghost", "ghost"),
      flash_(shaders, "flash", "flash"),
      line_(shaders, "line", "line"),
      backdrop_(shaders, "backdrop", "backdrop"),
      outline_(shaders, "outline", "outline"),
      lit_(std::make_unique<LitPass>(shaders, quality_)),
      ball_(make_sphere(1, {})),
      cone_(make_cone({})),
      tube_(make_tube({})),
      patch_(make_patch(1, {})),
      base_(upload_all(items.base)),
      moving_(upload_all(items.moving)) {
  glBindBuffer(GL_UNIFORM_BUFFER, frame_block_);
  glBufferData(GL_UNIFORM_BUFFER, sizeof(FrameBlock), nullptr, GL_STREAM_DRAW);
  glBindBuffer(GL_UNIFORM_BUFFER, 0);
  set_scene_items(items);
  set_surroundings(around);
}

void ScenePainter::set_quality(const Quality& quality) {
  lit_ = std::make_unique<LitPass>(shaders_, quality);
  quality_ = quality;
}

void ScenePainter::set_scene_items(const SceneItems& items) {
  world_ = upload_all(items.world);
  walls_ = upload_all(items.walls);
  probes_ = upload_all(items.probes);
  textured_world_ = std::any_of(items.world.begin(), items.world.end(),
                                [](const Item& item) { return !item.model.images.empty(); });
}

void ScenePainter::set_meshes(const std::vector<PlacedMesh>& meshes) {
  decltype(uploaded_) uploaded;
  meshes_.clear();
  highlighted_.clear();
  for (const PlacedMesh& mesh : meshes) {
    auto& model = uploaded[mesh.model];
    if (!model) {
      const auto known = uploaded_.find(mesh.model);
      model =
          known != uploaded_.end() ? known->second : std::make_shared<const GpuModel>(*mesh.model);
    }
    meshes_.push_back({model, mesh.pose, -1});
    if (mesh.highlighted) highlighted_.push_back(meshes_.back());
  }
  uploaded_ = std::move(uploaded);
}

void ScenePainter::set_surroundings(const Surroundings& around) {
  bounds_ = around.bounds;
  ground_height_ = static_cast<float>(around.ground);
}

bool ScenePainter::too_many_triangles() const {
  return LitPass::in_view(meshes_, view_) + LitPass::in_view(world_, view_) > quality_.triangles;
}

void ScenePainter::begin_frame(const Mood& mood, const Camera& camera) {
  const glm::vec3 to_light = glm::normalize(glm::vec3(-0.30f, -0.55f, 1.0f));
  lit_->shadow.aim(bounds_, to_light);
  const glm::vec2 size(camera.width(), camera.height());
  view_ = to_glm(Eigen::Matrix4d(camera.projection() * camera.view()));
  coarse_ = too_many_triangles();
  const FrameBlock block{view_,
                         lit_->shadow.lookup(),
                         glm::vec4(to_glm(camera.eye()), 1),
                         glm::vec4(to_light, lit_->shadow.texel()),
                         mood.key,
                         mood.sky,
                         mood.earth,
                         mood.ground,
                         mood.top,
                         mood.bottom,
                         glm::vec4(size, pixel_scale_ * static_cast<float>(quality_.scale), 0)};
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block_);
  glBufferSubData(GL_UNIFORM_BUFFER, 0, sizeof block, &block);
}

void ScenePainter::draw_shadows(const Links& proxy) {
  if (quality_.shadow_size <= 0) return;
  lit_->shadow.begin();
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 3.0f);
  depth_only_.use();
  const auto draw_one = [&](const GpuModel& model, const glm::mat4& pose) {
    const glm::mat4 to_clip = lit_->shadow.clip() * pose;
    if (!in_sight(model.box(), to_clip)) return;
    depth_only_.set("model_to_clip", to_clip);
    model.draw(true);  // a shadow's edge is not that sharp
  };
  each(base_, {}, draw_one);
  each(moving_, proxy, draw_one);
  each(world_, {}, draw_one);
  glDisable(GL_CULL_FACE);  // meshes may be open sheets
  each(meshes_, {}, draw_one);
  glEnable(GL_CULL_FACE);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void ScenePainter::draw_ground() const {
  const ShaderProgram& ground = lit_->ground;
  ground.use();
  ground.set("shadow_map", 1);
  const auto size = static_cast<float>(1.1 * bounds_.diagonal().norm());
  glm::mat4 floor(size);
  // A tenth of a millimetre down, so that what stands on it wins.
  floor[3] = glm::vec4(bounds_.center().x(), bounds_.center().y(), ground_height_ - 1e-4f, 1);
  ground.set("model", floor);
  patch_.draw();
}

// Stencil 2 marks the arm: a ghost behind it stays hidden, one behind the scene shines through.
void ScenePainter::draw_solid(const Mood& mood, const Links& proxy) {
  lit_->shadow.bind(1);
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glStencilFunc(GL_ALWAYS, 2, 0xff);
  lit_->draw_solid(moving_, proxy, view_, {.tint = linear(palette::kProxy, 0.85f)});
  lit_->draw_solid(base_, {}, view_, {});
  glStencilFunc(GL_ALWAYS, 0, 0xff);
  const bool cheap = !quality_.soft && !textured_world_;
  const LitPass::Look world{.tint = mood.object_tint, .matte = cheap, .coarse = coarse_};
  lit_->draw_solid(world_, {}, view_, world);
  lit_->draw_solid(meshes_, {}, view_, {.coarse = coarse_});
  draw_ground();

  backdrop_.use();
  glBindVertexArray(no_vertices_);
  glDepthMask(GL_FALSE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_BLEND);
  lit_->draw_blended(world_, {}, view_, world);
  lit_->draw_blended(meshes_, {}, view_, {.coarse = coarse_});
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDisable(GL_STENCIL_TEST);
  draw_outlines(mood);
}

// The inside of a slightly larger copy shows around the edge of what is highlighted.
void ScenePainter::draw_outlines(const Mood& mood) const {
  if (highlighted_.empty()) return;
  glCullFace(GL_FRONT);
  outline_.use();
  outline_.set("tint", mood.outline);
  each(highlighted_, {}, [&](const GpuModel& model, const glm::mat4& pose) {
    outline_.set("model", pose);
    model.draw(coarse_);
  });
  glCullFace(GL_BACK);
}

void ScenePainter::draw_translucent(const ShaderProgram& program, const std::vector<Drawable>& list,
                                    const Links& links, const palette::Rgb& color,
                                    glm::vec2 alpha) const {
  program.use();
  program.set("tint", srgb(color));
  program.set("alpha", alpha);
  each(list, links, [&](const GpuModel& model, const glm::mat4& pose) {
    program.set("model", pose);
    model.draw();
  });
}

void ScenePainter::draw_ghost(const Links& links, const palette::Rgb& color) {
  // A little behind its place, so that a proxy at the same place wins without flicker.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.0f, 8.0f);
  // First its depth alone, so that only the outermost surface shows; stencil 1 marks it.
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, 1, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  draw_translucent(ghost_depth_, moving_, links, color, {});
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_BLEND);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  draw_translucent(ghost_, moving_, links, color, {0.36f, 1.0f});
  // What the scene hides, faintly, each pixel once.
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);
  glStencilFunc(GL_EQUAL, 0, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
  draw_translucent(ghost_, moving_, links, color, {0.20f, 0.50f});
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  for (const GLenum off : {GL_BLEND, GL_STENCIL_TEST, GL_POLYGON_OFFSET_FILL}) glDisable(off);
}

void ScenePainter::draw_glass(const Links& proxy) {
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  draw_translucent(ghost_, walls_, proxy, palette::kContact, {0.30f, 0.75f});
  draw_translucent(ghost_, probes_, proxy, palette::kRerun, {0.10f, 0.55f});
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void ScenePainter::draw_solid_marks(const Marks& marks, float alpha) const {
  ghost_.use();
  ghost_.set("alpha", glm::vec2(alpha));
  for (const SolidMark& mark : marks.solids) {
    ghost_.set("tint", srgb(mark.color));
    ghost_.set("model", mark.place);
    switch (mark.shape) {
      case SolidMark::Shape::ball: ball_.draw(); break;
      case SolidMark::Shape::cone: cone_.draw(); break;
      case SolidMark::Shape::tube: tube_.draw(); break;
    }
  }
}

void ScenePainter::draw_marks(const Marks& marks) {
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_GREATER);  // through the table, faintly
  draw_solid_marks(marks, 0.45f);
  glDepthFunc(GL_LEQUAL);
  glDisable(GL_CULL_FACE);
  flash_.use();
  flash_.set("tint", srgb(palette::kContact));
  for (const FlashMark& mark : marks.flashes) {
    flash_.set("model", mark.place);
    flash_.set("pulse", mark.pulse);
    patch_.draw();
  }
  glEnable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  draw_solid_marks(marks, 1.0f);
  glDisable(GL_BLEND);
}

void ScenePainter::draw_lines(LineBatch& lines, bool on_top) {
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  if (on_top) glDisable(GL_DEPTH_TEST);
  line_.use();
  lines.draw();
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace limpid
