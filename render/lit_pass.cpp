#include "render/lit_pass.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "render/camera.h"
#include "render/gl/gl_names.h"

namespace limpid {

ShadowMap::ShadowMap(int size) : size_(std::max(0, size)) {
  allocate(still_);
  allocate(all_);
}

void ShadowMap::allocate(const Layer& layer) const {
  const GLsizei edge = std::max(1, size_);
  glBindTexture(GL_TEXTURE_2D, layer.depth);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, edge, edge, 0, GL_DEPTH_COMPONENT,
               GL_UNSIGNED_INT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  // Everything outside of the map is lit.
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  const float lit[] = {1, 1, 1, 1};
  glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, lit);
  glBindTexture(GL_TEXTURE_2D, 0);

  GLint before = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &before);
  glBindFramebuffer(GL_FRAMEBUFFER, layer.framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, layer.depth, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before));
}

void ShadowMap::aim(const Bounds& box, const glm::vec3& to_light) {
  const glm::vec3 center = to_glm(Vec3(box.center()));
  const float radius = 0.5f * static_cast<float>(box.diagonal().norm());
  const glm::mat4 view = glm::lookAt(center + 2.0f * radius * to_light, center, glm::vec3(0, 1, 0));
  clip_ = glm::ortho(-radius, radius, -radius, radius, 0.5f * radius, 3.5f * radius) * view;
  texel_ = 2 * radius / static_cast<float>(std::max(1, size_));
}

void ShadowMap::begin_still() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, still_.framebuffer);
  glViewport(0, 0, std::max(1, size_), std::max(1, size_));
  glClear(GL_DEPTH_BUFFER_BIT);
}

void ShadowMap::begin_moving(const PixelArea& area) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, still_.framebuffer);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, all_.framebuffer);
  glViewport(0, 0, std::max(1, size_), std::max(1, size_));
  const Eigen::Vector2i from = area.min(), to = area.max();
  glBlitFramebuffer(from.x(), from.y(), to.x(), to.y(), from.x(), from.y(), to.x(), to.y(),
                    GL_DEPTH_BUFFER_BIT, GL_NEAREST);
}

void ShadowMap::bind(GLuint unit) const {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, all_.depth);
  glActiveTexture(GL_TEXTURE0);
}

glm::mat4 ShadowMap::lookup() const {
  return glm::translate(glm::mat4(1), glm::vec3(0.5f)) * glm::scale(glm::mat4(1), glm::vec3(0.5f)) *
         clip_;
}

namespace {

constexpr GLuint kColorUnit = 0, kShadowUnit = 1, kSurfaceUnit = 2, kNormalUnit = 3,
                 kEmissionUnit = 4;

std::string shadow_defines(const Quality& quality, int hard_taps) {
  const int taps = quality.shadow_size <= 0 ? 0 : quality.soft ? 9 : hard_taps;
  return "SHADOW_TAPS " + std::to_string(taps) + "\nSHADOW_SIZE " +
         std::to_string(std::max(1, quality.shadow_size)) + ".0\n";
}

// Returns whether the coarse version's triangles are so small on the screen that nothing is lost.
bool coarse_enough(const GpuModel& model, const glm::mat4& to_clip, float pixels) {
  constexpr float kSmall = 6;  // a triangle [px]
  std::size_t indices = 0;
  for (const GpuModel::Piece& piece : model.pieces(true)) indices += piece.count;
  return pixels * share_of_view(model.box(), to_clip) < kSmall * static_cast<float>(indices / 3);
}

// Returns whether the vertices say everything about the look.
bool is_plain(const Finish& m) {
  Finish plain;
  plain.flat = m.flat;
  return m == plain;
}

// Returns the strength of each link's outline, by its distance from the proxy's: none at the same
// place, where it would surround the proxy.
std::vector<float> outlines_of(const ArmPose& ghost, const ArmPose& proxy,
                               double meters_per_pixel) {
  std::vector<float> strengths(ghost.links.size(), 1.0f);
  if (ghost.links.size() != proxy.links.size()) return strengths;
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    const bool last = i + 1 == strengths.size();
    const auto end = [&](const ArmPose& arm) {
      return last ? arm.tip : Vec3(arm.links[i + 1].translation());
    };
    const Vec3 off = ghost.links[i].translation() - proxy.links[i].translation();
    const double apart = std::max(off.norm(), (end(ghost) - end(proxy)).norm());
    strengths[i] = static_cast<float>(std::clamp((apart / meters_per_pixel - 1) / 3, 0.0, 1.0));
  }
  return strengths;
}

}  // namespace

LitPass::LitPass(const std::filesystem::path& shaders, const Quality& quality)
    : ground(shaders, "ground", "ground", shadow_defines(quality, 1)),
      shadow(quality.shadow_size),
      plain_(shaders, "lit", "lit", shadow_defines(quality, 4)),
      textured_(shaders, "lit", "lit", shadow_defines(quality, 4) + "TEXTURED 1\n"),
      matte_(shaders, "lit", "matte", shadow_defines(quality, 1) + "MATTE 1\n"),
      white_(upload({1, 1, {255, 255, 255, 255}})),
      flat_(upload({1, 1, {128, 128, 255, 255}, false})) {}

void LitPass::draw_solid(const std::vector<Drawable>& list, const Links& links,
                         const glm::mat4& view, const Look& look) const {
  draw_plain(look.matte ? matte_ : plain_, list, links, view, look);
  draw_textured(list, links, view, look, false);
}

void LitPass::draw_blended(const std::vector<Drawable>& list, const Links& links,
                           const glm::mat4& view, const Look& look) const {
  draw_textured(list, links, view, look, true);
}

std::size_t LitPass::in_view(const std::vector<Drawable>& list, const glm::mat4& view) {
  std::size_t indices = 0;
  for (const Drawable& item : list)
    for (const GpuModel::Piece& piece : item.model->pieces(false))
      if (in_sight(piece.box, view * item.pose)) indices += piece.count;
  return indices / 3;
}

void LitPass::draw_plain(const ShaderProgram& program, const std::vector<Drawable>& list,
                         const Links& links, const glm::mat4& view, const Look& look) const {
  program.use();
  program.set("shadow_map", static_cast<int>(kShadowUnit));
  for (const Drawable& item : list) {
    const auto pose = place(item, links);
    const GpuModel& model = *item.model;
    if (!pose || !in_sight(model.box(), view * *pose)) continue;
    const bool coarse = look.coarse || coarse_enough(model, view * *pose, look.pixels);
    program.set("tint", item.own_color ? glm::vec4(0) : look.tint);
    program.set("model", *pose);
    model.bind();
    for (const GpuModel::Piece& piece : model.pieces(coarse))
      if (is_plain(piece.material) && in_sight(piece.box, view * *pose)) model.draw(piece);
  }
}

void LitPass::bind_textures(const GpuModel& model, const Finish& m) const {
  const auto bind = [&](GLuint unit, int image, GLuint otherwise) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, image < 0 ? otherwise : model.texture(image));
  };
  bind(kSurfaceUnit, m.surface, white_);
  bind(kNormalUnit, m.normal, flat_);
  bind(kEmissionUnit, m.emission, white_);
  bind(kColorUnit, m.color, white_);
}

void LitPass::draw_textured(const std::vector<Drawable>& list, const Links& links,
                            const glm::mat4& view, const Look& look, bool blended) const {
  const auto drawn_here = [&](const Finish& m) {
    return !is_plain(m) && (m.alpha == Finish::Alpha::blend) == blended;
  };
  bool begun = false;
  each(list, links, [&](const GpuModel& model, const glm::mat4& pose) {
    if (!in_sight(model.box(), view * pose)) return;
    const bool coarse = look.coarse || coarse_enough(model, view * pose, look.pixels);
    for (const GpuModel::Piece& piece : model.pieces(coarse)) {
      const Finish& m = piece.material;
      if (!drawn_here(m) || !in_sight(piece.box, view * pose)) continue;
      if (!begun) {
        textured_.use();
        textured_.set("color_texture", static_cast<int>(kColorUnit));
        textured_.set("shadow_map", static_cast<int>(kShadowUnit));
        textured_.set("surface_texture", static_cast<int>(kSurfaceUnit));
        textured_.set("normal_texture", static_cast<int>(kNormalUnit));
        textured_.set("emission_texture", static_cast<int>(kEmissionUnit));
        textured_.set("tint", look.tint);
        begun = true;
      }
      textured_.set("model", pose);
      textured_.set("glow", glm::vec4(m.glow[0], m.glow[1], m.glow[2], 0));
      textured_.set("bump", m.normal < 0 ? 0.0f : m.bump);
      textured_.set("cutoff", m.alpha == Finish::Alpha::mask ? m.cutoff : -1.0f);
      bind_textures(model, m);
      if (m.two_sided) glDisable(GL_CULL_FACE);
      model.bind();
      model.draw(piece);
      if (m.two_sided) glEnable(GL_CULL_FACE);
    }
  });
}

Links links_of(const ArmPose& arm) {
  Links out;
  for (const Pose& pose : arm.links) {
    if (!pose.matrix().allFinite()) return {};
    out.push_back(to_glm(pose));
  }
  return out;
}

Links body_links(const std::vector<Pose>& seen, const std::vector<Pose>& starts) {
  Links out;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const bool known = i < seen.size() && seen[i].matrix().allFinite();
    out.push_back(to_glm(known ? seen[i] : starts[i]));
  }
  return out;
}

std::vector<BodyGhosts> body_ghosts(const ViewState& state, const std::vector<Pose>& starts,
                                    double meters_per_pixel) {
  constexpr double kSpan = 0.03;  // from a body's middle to its edge, which turns [m]
  std::vector<BodyGhosts> all;
  const auto add = [&](const std::vector<Pose>& bodies, const palette::Rgb& color) {
    if (bodies.empty()) return;
    BodyGhosts& ghosts = all.emplace_back(BodyGhosts{body_links(bodies, starts), {}, color});
    const std::size_t both = std::min(state.bodies.size(), bodies.size());
    for (std::size_t i = 0; i < std::min(both, starts.size()); ++i) {
      const Pose &a = state.bodies[i], &b = bodies[i];
      const double apart =
          (a.translation() - b.translation()).norm() + kSpan * (a.linear() - b.linear()).norm();
      ghosts.shown.push_back(apart > meters_per_pixel);
    }
  };
  add(state.rerun_bodies, palette::kRerun);
  for (std::size_t i = 0; i < state.beside.size(); ++i) {
    add(state.beside[i].bodies, palette::of_lane(palette::kProxy, i + 1, state.theme));
  }
  return all;
}

std::vector<Ghost> ghosts_of(const ViewState& state, double meters_per_pixel) {
  std::vector<Ghost> ghosts;
  if (state.rerun) {
    Links links = links_of(*state.rerun);
    std::vector<float> clear(links.size(), 1.0f);
    ghosts.push_back({std::move(links), palette::kRerun, std::move(clear)});
  }
  const auto add = [&](const ArmPose& arm, const ArmPose& over, const palette::Rgb& color) {
    ghosts.push_back({links_of(arm), color, outlines_of(arm, over, meters_per_pixel)});
  };
  for (std::size_t i = 0; i < state.beside.size(); ++i) {
    const OtherRun& run = state.beside[i];
    add(run.proxy, state.proxy, palette::of_lane(palette::kProxy, i + 1, state.theme));
    if (state.show_ghost) {
      add(run.device, state.device, palette::of_lane(palette::kDevice, i + 1, state.theme));
    }
  }
  if (state.show_ghost) add(state.device, state.proxy, palette::kDevice);
  return ghosts;
}

}  // namespace limpid
