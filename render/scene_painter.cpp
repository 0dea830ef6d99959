#include "render/scene_painter.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "render/glm_door.h"
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
    out.push_back({GpuModel(item.model), to_glm(item.pose), item.link});
  return out;
}

std::string renderer_name() {
  const GLubyte* name = glGetString(GL_RENDERER);
  return name ? reinterpret_cast<const char*>(name) : "";
}

std::string shadow_defines(const Quality& quality, int hard_taps) {
  const int taps = quality.shadow_size <= 0 ? 0 : quality.soft ? 25 : hard_taps;
  return "SHADOW_TAPS " + std::to_string(taps) + "\nSHADOW_SIZE " +
         std::to_string(std::max(1, quality.shadow_size)) + ".0\n";
}

}  // namespace

ScenePainter::Lighting::Lighting(const std::filesystem::path& shaders, const Quality& quality)
    : lit(shaders, "lit", "lit", shadow_defines(quality, 4)),
      matte(shaders, "lit", "matte", shadow_defines(quality, 1) + "MATTE 1\n"),
      ground(shaders, "ground", "ground", shadow_defines(quality, 1)),
      shadow(quality.shadow_size) {}

ScenePainter::ScenePainter(const std::filesystem::path& shaders, const SceneItems& items)
    : shaders_(shaders),
      quality_(Quality::automatic(renderer_name())),
      depth_only_(shaders, "shadow", "shadow"),
      ghost_depth_(shaders, "ghost", "shadow"),
      ghost_(shaders, "ghost", "ghost"),
      flash_(shaders, "flash", "flash"),
      line_(shaders, "line", "line"),
      backdrop_(shaders, "backdrop", "backdrop"),
      lighting_(std::make_unique<Lighting>(shaders, quality_)),
      white_(upload({1, 1, {255, 255, 255, 255}})),
      ball_(make_sphere(1, {})),
      cone_(make_cone({})),
      tube_(make_tube({})),
      patch_(make_patch(1, {})),
      base_(upload_all(items.base)),
      moving_(upload_all(items.moving)),
      world_(upload_all(items.world)),
      walls_(upload_all(items.walls)),
      probes_(upload_all(items.probes)),
      bounds_(items.bounds),
      ground_height_(static_cast<float>(items.ground)),
      textured_world_(std::any_of(items.world.begin(), items.world.end(),
                                  [](const Item& item) { return !item.model.images.empty(); })) {
  glBindBuffer(GL_UNIFORM_BUFFER, frame_block_);
  glBufferData(GL_UNIFORM_BUFFER, sizeof(FrameBlock), nullptr, GL_STREAM_DRAW);
  glBindBuffer(GL_UNIFORM_BUFFER, 0);
}

void ScenePainter::set_quality(const Quality& quality) {
  lighting_ = std::make_unique<Lighting>(shaders_, quality);
  quality_ = quality;
}

template <class Draw>
void ScenePainter::each(const std::vector<Drawable>& list, const Links& links,
                        Draw&& draw_one) const {
  for (const Drawable& item : list) {
    const auto link = static_cast<std::size_t>(std::max(0, item.link));
    if (item.link < 0) {
      draw_one(item.model, item.pose);
    } else if (link < links.size()) {
      draw_one(item.model, links[link] * item.pose);
    }
  }
}

void ScenePainter::begin_frame(const Mood& mood, const Camera& camera) {
  const glm::vec3 to_light = glm::normalize(glm::vec3(-0.30f, -0.55f, 1.0f));
  lighting_->shadow.aim(bounds_, to_light);
  const glm::vec2 size(camera.width(), camera.height());
  const FrameBlock block{to_glm(Eigen::Matrix4d(camera.projection() * camera.view())),
                         lighting_->shadow.lookup(),
                         glm::vec4(to_glm(camera.eye()), 1),
                         glm::vec4(to_light, lighting_->shadow.texel()),
                         mood.key,
                         mood.sky,
                         mood.earth,
                         mood.ground,
                         mood.top,
                         mood.bottom,
                         glm::vec4(size, pixel_scale_, 0)};
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block_);
  glBufferSubData(GL_UNIFORM_BUFFER, 0, sizeof block, &block);
}

void ScenePainter::draw_shadows(const Links& proxy) {
  if (quality_.shadow_size <= 0) return;
  lighting_->shadow.begin();
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 3.0f);
  depth_only_.use();
  const auto draw_one = [&](const GpuModel& model, const glm::mat4& pose) {
    depth_only_.set("model_to_clip", lighting_->shadow.clip() * pose);
    model.draw();
  };
  each(base_, {}, draw_one);
  each(moving_, proxy, draw_one);
  each(world_, {}, draw_one);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void ScenePainter::draw_lit(const ShaderProgram& program, const std::vector<Drawable>& list,
                            const Links& links, const glm::vec4& tint) const {
  program.use();
  program.set("base_texture", 0);
  program.set("shadow_map", 1);
  program.set("tint", tint);
  each(list, links, [&](const GpuModel& model, const glm::mat4& pose) {
    program.set("model", pose);
    model.draw_textured(white_);
  });
}

void ScenePainter::draw_ground() const {
  const ShaderProgram& ground = lighting_->ground;
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
  lighting_->shadow.bind(1);
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glStencilFunc(GL_ALWAYS, 2, 0xff);
  draw_lit(lighting_->lit, moving_, proxy, linear(palette::kProxy, 0.85f));
  draw_lit(lighting_->lit, base_, {}, glm::vec4(0));
  glStencilFunc(GL_ALWAYS, 0, 0xff);
  const bool cheap = !quality_.soft && !textured_world_;
  draw_lit(cheap ? lighting_->matte : lighting_->lit, world_, {}, mood.object_tint);
  draw_ground();

  backdrop_.use();
  glBindVertexArray(no_vertices_);
  glDepthMask(GL_FALSE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);
  glDisable(GL_STENCIL_TEST);
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
  glDisable(GL_DEPTH_TEST);  // a contact is half inside of what it touches
  flash_.use();
  flash_.set("tint", srgb(palette::kContact));
  for (const FlashMark& mark : marks.flashes) {
    flash_.set("model", mark.place);
    flash_.set("pulse", mark.pulse);
    patch_.draw();
  }
  glEnable(GL_DEPTH_TEST);
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
