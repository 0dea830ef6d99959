// Ghosts, glass, marks and lines: what explains the picture.
#include "render/gl/glm_door.h"
#include "render/scene_painter.h"

namespace limpid {
namespace {

glm::vec4 srgb(const palette::Rgb& c) { return {c[0], c[1], c[2], 1}; }

}  // namespace

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

// Around what of the ghost can be seen, and around what the scene hides of it.
void ScenePainter::draw_ghost_outline(const Ghost& ghost, int mark) const {
  const Links& links = ghost.links;
  const palette::Rgb& color = ghost.color;
  const std::vector<float>& outline = ghost.outline;
  glCullFace(GL_FRONT);
  outline_.use();
  // With one sample a pixel a thinner line would come and go.
  outline_.set("width", quality_.msaa > 1 ? 1.6f : 2.2f);
  const auto draw = [&](float share) {
    for (const Drawable& item : moving_) {
      const auto link = static_cast<std::size_t>(item.link);
      if (link >= outline.size() || link >= links.size() || !(outline[link] > 0)) continue;
      outline_.set("tint", glm::vec4(color[0], color[1], color[2], share * outline[link]));
      outline_.set("model", links[link] * item.pose);
      item.model->draw(true);
    }
  };
  glDepthMask(GL_FALSE);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glStencilFunc(GL_NOTEQUAL, mark, 0xff);
  draw(1.0f);
  glDepthFunc(GL_GREATER);
  glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
  glStencilFunc(GL_EQUAL, 0, 0xff);
  draw(0.7f);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glCullFace(GL_BACK);
}

void ScenePainter::draw_ghost(const Ghost& ghost, std::size_t number) {
  const Links& links = ghost.links;
  const palette::Rgb& color = ghost.color;
  const int mark = 3 + static_cast<int>(number);
  // A little behind its place, so that a proxy at the same place wins without flicker.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.0f, 8.0f);
  // First its depth alone, so that only the outermost surface shows; a number in the stencil marks
  // it.
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, mark, 0xff);
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
  draw_ghost_outline(ghost, mark);
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

void ScenePainter::draw_solid_marks(const std::vector<SolidMark>& marks, glm::vec2 alpha) const {
  ghost_.use();
  ghost_.set("alpha", alpha);
  for (const SolidMark& mark : marks) {
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
  draw_solid_marks(marks.solids, glm::vec2(0.45f));
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
  draw_solid_marks(marks.solids, glm::vec2(1.0f));
  glDepthMask(GL_FALSE);
  glDisable(GL_CULL_FACE);
  draw_solid_marks(marks.glass, glm::vec2(0.16f, 0.60f));
  glEnable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
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

// On the scene alone: what is marked in the stencil stands before it.
void ScenePainter::draw_shades(const Marks& marks) const {
  if (marks.shades.empty()) return;
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  glDisable(GL_CULL_FACE);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_EQUAL, 0, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  shade_.use();
  for (const glm::mat4& place : marks.shades) {
    shade_.set("model", place);
    shade_.set("strength", 0.62f * glm::length(glm::vec3(place[2])));
    patch_.draw();
  }
  glDisable(GL_STENCIL_TEST);
  glEnable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace limpid
