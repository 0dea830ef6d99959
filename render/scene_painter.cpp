#include "render/scene_painter.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "render/gl/glm_door.h"
#include "render/gl/offscreen.h"
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

std::vector<Drawable> upload_all(const std::vector<Item>& items) {
  std::vector<Drawable> out;
  for (const Item& item : items)
    out.push_back({std::make_shared<const GpuModel>(item.model), to_glm(item.pose), item.link});
  return out;
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
      shade_(shaders, "flash", "shade"),
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
  still_shadows_ = false;
}

void ScenePainter::set_scene_items(const SceneItems& items) {
  world_ = upload_all(items.world);
  walls_ = upload_all(items.walls);
  probes_ = upload_all(items.probes);
  still_shadows_ = false;
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
  still_shadows_ = false;
}

void ScenePainter::set_surroundings(const Surroundings& around) {
  bounds_ = around.bounds;
  ground_height_ = static_cast<float>(around.ground);
  still_shadows_ = false;
}

bool ScenePainter::too_many_triangles() const {
  return LitPass::in_view(meshes_, view_) + LitPass::in_view(world_, view_) > quality_.triangles;
}

void ScenePainter::begin_frame(const Mood& mood, const Camera& camera) {
  lit_->shadow.aim(bounds_, kToLight);
  const glm::vec2 size(camera.width(), camera.height());
  seen_ = view_ = to_glm(Eigen::Matrix4d(camera.projection() * camera.view()));
  pixels_ = size.x * size.y;
  coarse_ = too_many_triangles();
  const FrameBlock block{view_,
                         lit_->shadow.lookup(),
                         glm::vec4(to_glm(camera.eye()), 1),
                         glm::vec4(kToLight, lit_->shadow.texel()),
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
  lit_->draw_solid(moving_, proxy, seen_,
                   {.tint = linear(palette::kProxy, 0.85f), .pixels = pixels_});
  lit_->draw_solid(base_, {}, seen_, {.pixels = pixels_});
  glStencilFunc(GL_ALWAYS, 0, 0xff);
  const bool cheap = !quality_.soft && !textured_world_;
  const LitPass::Look world{
      .tint = mood.object_tint, .matte = cheap, .coarse = coarse_, .pixels = pixels_};
  lit_->draw_solid(world_, {}, seen_, world);
  lit_->draw_solid(meshes_, {}, seen_, {.coarse = coarse_, .pixels = pixels_});
  draw_ground();

  backdrop_.use();
  glBindVertexArray(no_vertices_);
  glDepthMask(GL_FALSE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_BLEND);
  lit_->draw_blended(world_, {}, seen_, world);
  lit_->draw_blended(meshes_, {}, seen_, {.coarse = coarse_, .pixels = pixels_});
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
  outline_.set("width", 2.5f);
  each(highlighted_, {}, [&](const GpuModel& model, const glm::mat4& pose) {
    outline_.set("model", pose);
    model.draw(coarse_);
  });
  glCullFace(GL_BACK);
}

}  // namespace limpid
