#include "render/scene_view.h"

#include "render/frame_target.h"
#include "render/glm_door.h"
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
    for (const GLenum unit : {GL_TEXTURE1, GL_TEXTURE0}) {
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

}  // namespace

struct SceneView::Impl {
  Impl(const std::filesystem::path& shaders, const SceneItems& items)
      : bounds(items.bounds), grid(items.grid), painter(shaders, items), target(shaders) {}

  Bounds bounds, grid;
  ScenePainter painter;
  FrameTarget target;
  LineBatch floor_lines, trails, lines_on_top;
};

SceneView::SceneView(const std::filesystem::path& shaders, const ArmDescription& arm,
                     const Scene& scene)
    : impl_(std::make_unique<Impl>(shaders, collect_items(arm, scene))) {}
SceneView::~SceneView() = default;
SceneView::SceneView(SceneView&&) noexcept = default;
SceneView& SceneView::operator=(SceneView&&) noexcept = default;

void SceneView::draw(const ViewState& state, const Camera& camera, int x, int y, int width,
                     int height) {
  if (width < 1 || height < 1) return;
  const CallersState caller;
  Camera eye = camera;
  eye.resize(width, height);
  const Mood mood = mood_of(state.theme);
  const Links device = links_of(state.device), proxy = links_of(state.proxy);
  for (LineBatch* lines : {&impl_->floor_lines, &impl_->trails, &impl_->lines_on_top})
    lines->clear();
  if (state.show_grid) add_grid(impl_->grid, state.theme, impl_->floor_lines);
  if (state.show_trail) add_trails(state, impl_->trails);
  add_lines_on_top(state, impl_->lines_on_top);

  ScenePainter& painter = impl_->painter;
  painter.begin_frame(mood, eye);
  painter.draw_shadows(proxy);
  impl_->target.begin(width, height, painter.quality().msaa);
  painter.draw_solid(mood, proxy);
  painter.draw_lines(impl_->floor_lines, false);
  painter.draw_glass(proxy);
  if (state.rerun) painter.draw_ghost(links_of(*state.rerun), palette::kRerun);
  if (state.show_ghost) painter.draw_ghost(device, palette::kDevice);
  painter.draw_marks(collect_marks(state, eye, painter.pixel_scale()));
  painter.draw_lines(impl_->trails, false);
  painter.draw_lines(impl_->lines_on_top, true);
  impl_->target.finish(caller.framebuffer(), x, y);
}

const Bounds& SceneView::bounds() const { return impl_->bounds; }
const Bounds& SceneView::grid() const { return impl_->grid; }
const Quality& SceneView::quality() const { return impl_->painter.quality(); }
void SceneView::set_quality(const Quality& quality) { impl_->painter.set_quality(quality); }
void SceneView::set_pixel_scale(double scale) { impl_->painter.set_pixel_scale(scale); }

}  // namespace limpid
