// Solid surfaces in the key light with their shadows, and the frames of the arms and bodies drawn.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "render/camera.h"
#include "render/damage.h"
#include "render/gl/gl_names.h"
#include "render/gl/gpu_model.h"
#include "render/gl/shader_program.h"
#include "render/palette.h"
#include "render/quality.h"
#include "render/view_state.h"

namespace limpid {

// A depth picture of the scene from the key light's side.
class ShadowMap {
 public:
  explicit ShadowMap(int size);  // edge in texels, 0: none

  // Aims the light, given as the unit vector towards it, at a box of the world.
  void aim(const Bounds& box, const glm::vec3& to_light);
  // Casters are drawn with clip() * model. begin_still() comes first, seldom, for those that stay
  // where they are; begin_moving() draws the others into an area of a copy.
  void begin_still() const;
  void begin_moving(const PixelArea& area) const;
  void bind(GLuint unit) const;

  int size() const { return size_; }
  const glm::mat4& clip() const { return clip_; }  // world to the map's clip space
  glm::mat4 lookup() const;                        // world to 0..1 in the map
  float texel() const { return texel_; }           // edge of one texel in the world [m]

 private:
  int size_;
  struct Layer {
    GlTexture depth;
    GlFramebuffer framebuffer;
  };
  void allocate(const Layer& layer) const;

  Layer still_, all_;
  glm::mat4 clip_{1.0f};
  float texel_ = 0;
};

// A model on the graphics card, in a link's frame.
struct Drawable {
  std::shared_ptr<const GpuModel> model;
  glm::mat4 pose;          // in the frame of `link`
  int link;                // -1: the world
  bool own_color = false;  // keeps it, whatever the tint of its list
};

// The link frames of one arm; empty if it is not drawn.
using Links = std::vector<glm::mat4>;

// Returns the item's pose in the world; none if it is not drawn.
inline std::optional<glm::mat4> place(const Drawable& item, const Links& links) {
  if (item.link < 0) return item.pose;
  if (static_cast<std::size_t>(item.link) >= links.size()) return std::nullopt;
  return links[static_cast<std::size_t>(item.link)] * item.pose;
}

// Calls draw_one(model, pose in the world) for each item that is drawn.
template <class Draw>
void each(const std::vector<Drawable>& list, const Links& links, Draw&& draw_one) {
  for (const Drawable& item : list) {
    if (const auto pose = place(item, links)) draw_one(*item.model, *pose);
  }
}

// Draws surfaces in the scene's light. Is made anew when the quality changes.
class LitPass {
 public:
  LitPass(const std::filesystem::path& shaders, const Quality& quality);

  struct Look {
    glm::vec4 tint{0};    // linear; w: amount
    bool matte = false;   // diffuse light only, computed at the vertices
    bool coarse = false;  // else coarse only where it looks the same
    float pixels = 1e9f;  // number in the view
  };
  // Draws what hides things behind it; `view` is the world to clip space.
  void draw_solid(const std::vector<Drawable>& list, const Links& links, const glm::mat4& view,
                  const Look& look) const;
  // Draws what shines through, after everything solid.
  void draw_blended(const std::vector<Drawable>& list, const Links& links, const glm::mat4& view,
                    const Look& look) const;
  // Counts the triangles of `list` in sight.
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

// A translucent arm in the picture, besides the proxy.
struct Ghost {
  Links links;
  palette::Rgb color;
  std::vector<float> outline;  // strength for each link, 0 to 1
};

// Bodies of a further run or re-run that are elsewhere than those of the first.
struct BodyGhosts {
  Links links;
  std::vector<bool> shown;  // of each body
  palette::Rgb color{};

  bool has(int body) const {
    const auto i = static_cast<std::size_t>(body);
    return i < shown.size() && shown[i];
  }
};

// Returns the frame of each body: as seen, else as it starts.
Links body_links(const std::vector<Pose>& seen, const std::vector<Pose>& starts);
std::vector<BodyGhosts> body_ghosts(const ViewState& state, const std::vector<Pose>& starts,
                                    double meters_per_pixel);

// Returns the frame of each link; none if any is not finite.
Links links_of(const ArmPose& arm);
// Returns the ghosts in the order of drawing. `meters_per_pixel` at the tips.
std::vector<Ghost> ghosts_of(const ViewState& state, double meters_per_pixel);

}  // namespace limpid
