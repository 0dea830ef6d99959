#include "render/scene_view.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "render/gl/frame_target.h"
#include "render/gl/glm_door.h"
#include "render/scene_painter.h"

namespace limpid {
namespace {

Links links_of(const ArmPose& arm) {
  Links out;
  for (const Pose& pose : arm.links) {
    if (!pose.matrix().allFinite()) return {};
    out.push_back(to_glm(pose));
  }
  return out;
}

// Where the caller was drawing, put back at the end of the scope with a plain state.
class CallersState {
 public:
  CallersState() {
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer_);
    glGetIntegerv(GL_VIEWPORT, viewport_);
    for (const GLenum off : {GL_BLEND, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_FRAMEBUFFER_SRGB})
      glDisable(off);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glDepthFunc(GL_LEQUAL);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  }
  ~CallersState() {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glBindVertexArray(0);
    glUseProgram(0);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, 0);
    for (GLenum unit = GL_TEXTURE5; unit-- > GL_TEXTURE0;) {
      glActiveTexture(unit);
      glBindTexture(GL_TEXTURE_2D, 0);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer());
    glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  }
  CallersState(const CallersState&) = delete;
  CallersState& operator=(const CallersState&) = delete;
  GLuint framebuffer() const { return static_cast<GLuint>(framebuffer_); }

 private:
  GLint framebuffer_ = 0, viewport_[4] = {};
};

Eigen::Affine3d placed(const MeshPicture& mesh) {
  return Eigen::Affine3d(mesh.pose) * Eigen::Scaling(mesh.scale);
}

bool drawable(const MeshPicture& mesh) {
  return mesh.model && !mesh.model->indices.empty() && mesh.scale > 0 &&
         placed(mesh).matrix().allFinite();
}

}  // namespace

struct SceneView::Impl {
  Impl(const std::filesystem::path& shaders, const ArmDescription& description, const Scene& scene,
       std::span<const VisualPicture> visuals)
      : arm(description),
        items(collect_items(arm, scene, visuals)),
        surroundings(surroundings_of(items, {})),
        painter(shaders, items, surroundings),
        target(shaders) {}

  void use_surroundings() {
    std::vector<Bounds> boxes;
    for (const MeshPicture& mesh : meshes) {
      const auto [known, is_new] = model_bounds.try_emplace(mesh.model.get());
      if (is_new) known->second = mesh.model->bounds();
      boxes.push_back(moved(known->second, placed(mesh)));
    }
    surroundings = surroundings_of(items, boxes);
    painter.set_surroundings(surroundings);
  }

  ArmDescription arm;
  SceneItems items;
  Surroundings surroundings;
  std::vector<MeshPicture> meshes;
  std::map<const Model*, Bounds> model_bounds;  // of those in `meshes`
  ScenePainter painter;
  FrameTarget target;
  LineBatch floor_lines, trails, lines_on_top;
};

SceneView::SceneView(const std::filesystem::path& shaders, const ArmDescription& arm,
                     const Scene& scene, std::span<const VisualPicture> visuals)
    : impl_(std::make_unique<Impl>(shaders, arm, scene, visuals)) {}
SceneView::~SceneView() = default;
SceneView::SceneView(SceneView&&) noexcept = default;
SceneView& SceneView::operator=(SceneView&&) noexcept = default;

void SceneView::set_scene(const Scene& scene, std::span<const VisualPicture> visuals) {
  SceneItems items = impl_->items;
  collect_scene_items(impl_->arm, scene, visuals, items);
  impl_->painter.set_scene_items(items);
  impl_->items = std::move(items);
  impl_->use_surroundings();
}

void SceneView::set_meshes(std::span<const MeshPicture> meshes) {
  std::vector<MeshPicture> kept;
  std::copy_if(meshes.begin(), meshes.end(), std::back_inserter(kept), drawable);
  std::erase_if(impl_->model_bounds, [&](const auto& known) {
    return std::none_of(kept.begin(), kept.end(),
                        [&](const MeshPicture& m) { return m.model.get() == known.first; });
  });
  std::vector<PlacedMesh> placed_meshes;
  for (const MeshPicture& mesh : kept)
    placed_meshes.push_back(
        {mesh.model, to_glm(Eigen::Matrix4d(placed(mesh).matrix())), mesh.highlighted});
  impl_->painter.set_meshes(placed_meshes);
  impl_->meshes = std::move(kept);
  impl_->use_surroundings();
}

void SceneView::draw(const ViewState& state, const Camera& camera, int x, int y, int width,
                     int height) {
  if (width < 1 || height < 1) return;
  const CallersState caller;
  ScenePainter& painter = impl_->painter;
  const double scale = std::clamp(painter.quality().scale, 0.1, 1.0);
  const int columns = std::max(1, static_cast<int>(std::lround(width * scale)));
  const int rows = std::max(1, static_cast<int>(std::lround(height * scale)));
  Camera eye = camera;
  eye.resize(columns, rows);
  const Mood mood = mood_of(state.theme);
  const Links device = links_of(state.device), proxy = links_of(state.proxy);
  for (LineBatch* lines : {&impl_->floor_lines, &impl_->trails, &impl_->lines_on_top})
    lines->clear();
  if (state.show_grid) add_grid(impl_->surroundings.grid, state.theme, impl_->floor_lines);
  if (state.show_trail) add_trails(state, impl_->trails);
  add_lines_on_top(state, impl_->lines_on_top);

  painter.begin_frame(mood, eye);
  painter.draw_shadows(proxy);
  impl_->target.begin(columns, rows, painter.quality().msaa);
  painter.draw_solid(mood, proxy);
  painter.draw_lines(impl_->floor_lines, false);
  painter.draw_glass(proxy);
  if (state.rerun) painter.draw_ghost(links_of(*state.rerun), palette::kRerun);
  if (state.show_ghost) painter.draw_ghost(device, palette::kDevice);
  painter.draw_marks(collect_marks(state, eye, painter.pixel_scale() * scale));
  painter.draw_lines(impl_->trails, false);
  painter.draw_lines(impl_->lines_on_top, true);
  impl_->target.finish(caller.framebuffer(), x, y, width, height);
}

const Bounds& SceneView::bounds() const { return impl_->surroundings.bounds; }
const Bounds& SceneView::grid() const { return impl_->surroundings.grid; }
const Quality& SceneView::quality() const { return impl_->painter.quality(); }
void SceneView::set_quality(const Quality& quality) { impl_->painter.set_quality(quality); }
void SceneView::set_pixel_scale(double scale) { impl_->painter.set_pixel_scale(scale); }

}  // namespace limpid
