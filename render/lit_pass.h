// Solid surfaces in the scene's light.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "render/gl/gpu_model.h"
#include "render/gl/shader_program.h"
#include "render/quality.h"
#include "render/shadow_map.h"

namespace limpid {

struct Drawable {
  std::shared_ptr<const GpuModel> model;
  glm::mat4 pose;  // in the frame of `link`
  int link;        // -1: the world
};

// The link frames of one arm; empty if it is not drawn.
using Links = std::vector<glm::mat4>;

// Calls draw_one(model, pose in the world) for each that is drawn.
template <class Draw>
void each(const std::vector<Drawable>& list, const Links& links, Draw&& draw_one) {
  for (const Drawable& item : list) {
    if (item.link < 0) {
      draw_one(*item.model, item.pose);
    } else if (static_cast<std::size_t>(item.link) < links.size()) {
      draw_one(*item.model, links[static_cast<std::size_t>(item.link)] * item.pose);
    }
  }
}

// Made anew when the quality changes.
class LitPass {
 public:
  LitPass(const std::filesystem::path& shaders, const Quality& quality);

  struct Look {
    glm::vec4 tint{0};    // linear; w: how much of it
    bool matte = false;   // diffuse light only, worked out at the vertices
    bool coarse = false;  // else only what would look the same
    float pixels = 1e9f;  // that the view has
  };
  // What hides what is behind it; `view` is the world to clip space.
  void draw_solid(const std::vector<Drawable>& list, const Links& links, const glm::mat4& view,
                  const Look& look) const;
  // What shines through, after everything solid.
  void draw_blended(const std::vector<Drawable>& list, const Links& links, const glm::mat4& view,
                    const Look& look) const;
  // Triangles of `list` in sight.
  static std::size_t in_view(const std::vector<Drawable>& list, const glm::mat4& view);

  ShaderProgram ground;
  ShadowMap shadow;

 private:
  void draw_plain(const ShaderProgram& program, const std::vector<Drawable>& list,
                  const Links& links, const glm::mat4& view, const Look& look) const;
  void draw_textured(const std::vector<Drawable>& list, const Links& links, const glm::mat4& view,
                     const Look& look, bool blended) const;
  void bind_textures(const GpuModel& model, const Finish& material) const;

  ShaderProgram plain_, textured_, matte_;
  GlTexture white_, flat_;
};

}  // namespace limpid
