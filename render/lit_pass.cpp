#include "render/lit_pass.h"

#include <algorithm>
#include <string>

#include "render/frustum.h"

namespace limpid {
namespace {

constexpr GLuint kColorUnit = 0, kShadowUnit = 1, kSurfaceUnit = 2, kNormalUnit = 3,
                 kEmissionUnit = 4;

std::string shadow_defines(const Quality& quality, int hard_taps) {
  const int taps = quality.shadow_size <= 0 ? 0 : quality.soft ? 9 : hard_taps;
  return "SHADOW_TAPS " + std::to_string(taps) + "\nSHADOW_SIZE " +
         std::to_string(std::max(1, quality.shadow_size)) + ".0\n";
}

// Whether the coarse version's triangles are so small on the screen that nothing is lost by it.
bool coarse_enough(const GpuModel& model, const glm::mat4& to_clip, float pixels) {
  constexpr float kSmall = 6;  // a triangle [px]
  std::size_t indices = 0;
  for (const GpuModel::Piece& piece : model.pieces(true)) indices += piece.count;
  return pixels * share_of_view(model.box(), to_clip) < kSmall * static_cast<float>(indices / 3);
}

// Vertices say everything about it.
bool is_plain(const Finish& m) {
  Finish plain;
  plain.flat = m.flat;
  return m == plain;
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
  program.set("tint", look.tint);
  each(list, links, [&](const GpuModel& model, const glm::mat4& pose) {
    if (!in_sight(model.box(), view * pose)) return;
    const bool coarse = look.coarse || coarse_enough(model, view * pose, look.pixels);
    program.set("model", pose);
    model.bind();
    for (const GpuModel::Piece& piece : model.pieces(coarse))
      if (is_plain(piece.material) && in_sight(piece.box, view * pose)) model.draw(piece);
  });
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

}  // namespace limpid
