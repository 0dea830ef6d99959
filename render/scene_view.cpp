#include "render/scene_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <iterator>
#include <map>
#include <optional>

#include "render/damage.h"
#include "render/gl/frame_target.h"
#include "render/gl/gl_names.h"
#include "render/lit_pass.h"
#include "render/scene_painter.h"

namespace limpid {
namespace {

// Keeps the caller's framebuffer and viewport; restores them at the end of the scope, with a plain
// state.
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

// Switches of a state that change the picture everywhere.
struct Still {
  Theme theme = Theme::dark;
  bool grid = true;
  bool operator==(const Still&) const = default;
};

// A picture as it was drawn the last time.
struct DrawnSheet {
  explicit DrawnSheet(const std::filesystem::path& shaders) : target(shaders) {}

  FrameTarget target;
  LineBatch floor_lines, trails, lines_on_top;
  Damage damage;
  std::optional<ViewState> drawn;
  Eigen::Matrix4d camera = Eigen::Matrix4d::Zero();
  std::uint64_t version = 0;
  Still still;
  Eigen::Vector2i shown = Eigen::Vector2i::Zero();  // its size [px]

  bool differs(const ViewState& state, const Camera& eye, std::uint64_t now) const {
    constexpr double kTellable = 0.1;  // [px]
    if (!drawn || version != now || shown.x() != eye.width() || shown.y() != eye.height() ||
        camera != matrix_of(eye))
      return true;
    return !same_picture(state, *drawn, kTellable * eye.meters_per_pixel(state.proxy.tip));
  }
  static Eigen::Matrix4d matrix_of(const Camera& eye) { return eye.projection() * eye.view(); }
};

FrameTarget::Area area_of(const PixelArea& area) {
  if (area.isEmpty()) return {0, 0, 0, 0};
  const Eigen::Vector2i size = area.sizes();
  return {area.min().x(), area.min().y(), size.x(), size.y()};
}

}  // namespace

struct SceneView::Impl {
  Impl(const std::filesystem::path& shaders, const ArmDescription& description, const Scene& scene,
       std::span<const VisualPicture> visuals)
      : arm(description),
        items(collect_items(arm, scene, visuals)),
        surroundings(surroundings_of(items, {})),
        painter(shaders, items, surroundings) {
    while (sheets.size() < kSheets) sheets.emplace_back(shaders);
  }

  void use_surroundings() {
    std::vector<Bounds> boxes;
    for (const MeshPicture& mesh : meshes) {
      const auto [known, is_new] = model_bounds.try_emplace(mesh.model.get());
      if (is_new) known->second = mesh.model->bounds();
      const auto body = static_cast<std::size_t>(mesh.body);
      const Pose start = body < items.starts.size() ? items.starts[body] : Pose::Identity();
      boxes.push_back(moved(known->second, Eigen::Affine3d(start) * placed(mesh)));
    }
    surroundings = surroundings_of(items, boxes);
    painter.set_surroundings(surroundings);
    ++version;
  }

  // Returns true if the picture differs from the last one.
  bool draw(DrawnSheet& sheet, const ViewState& wanted, const Camera& camera,
            const FrameTarget::Area& to);
  // Returns the area that had to be drawn anew.
  PixelArea paint(DrawnSheet& sheet, const ViewState& state, const Camera& eye, double scale);

  ArmDescription arm;
  SceneItems items;
  Surroundings surroundings;
  std::vector<MeshPicture> meshes;
  std::map<const Model*, Bounds> model_bounds;  // of those in `meshes`
  ScenePainter painter;
  static constexpr std::size_t kSheets =
      static_cast<std::size_t>(SceneView::Sheet::beside) + kMostLanes - 1;
  std::deque<DrawnSheet> sheets;  // by SceneView::Sheet
  std::uint64_t version = 1;      // of everything that stands still
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
        {mesh.model, to_glm(Eigen::Matrix4d(placed(mesh).matrix())), mesh.highlighted, mesh.body});
  impl_->painter.set_meshes(placed_meshes);
  impl_->meshes = std::move(kept);
  impl_->use_surroundings();
}

bool SceneView::draw(const ViewState& state, const Camera& camera, int x, int y, int width,
                     int height, Sheet on) {
  return impl_->draw(impl_->sheets[static_cast<std::size_t>(on)], state, camera,
                     {x, y, width, height});
}

bool SceneView::differs(const ViewState& state, const Camera& camera, Sheet on) const {
  return impl_->sheets[static_cast<std::size_t>(on)].differs(state, camera, impl_->version);
}

bool SceneView::Impl::draw(DrawnSheet& sheet, const ViewState& wanted, const Camera& camera,
                           const FrameTarget::Area& to) {
  if (to.width < 1 || to.height < 1) return false;
  const CallersState caller;
  Camera shown = camera;
  shown.resize(to.width, to.height);
  const bool differs = sheet.differs(wanted, shown, version);
  if (differs) {
    if (sheet.version != version) sheet.damage.spoil();
    sheet.drawn = wanted;
    sheet.version = version;
    sheet.camera = DrawnSheet::matrix_of(shown);
    sheet.shown = {to.width, to.height};
  }
  const double scale = std::clamp(painter.quality().scale, 0.1, 1.0);
  const int columns = std::max(1, static_cast<int>(std::lround(to.width * scale)));
  const int rows = std::max(1, static_cast<int>(std::lround(to.height * scale)));
  PixelArea changed;
  if (differs) {
    Camera eye = camera;
    eye.resize(columns, rows);
    changed = paint(sheet, *sheet.drawn, eye, scale);
  } else {
    sheet.target.begin(columns, rows, painter.quality().msaa);
  }
  sheet.target.finish(caller.framebuffer(), to, area_of(changed));
  return differs;
}

PixelArea SceneView::Impl::paint(DrawnSheet& sheet, const ViewState& state, const Camera& eye,
                                 double scale) {
  const auto columns = static_cast<int>(eye.width()), rows = static_cast<int>(eye.height());
  const Lighting lighting = lighting_of(state.theme);
  const Links proxy = links_of(state.proxy);
  for (LineBatch* lines : {&sheet.floor_lines, &sheet.trails, &sheet.lines_on_top}) lines->clear();
  if (state.show_grid) add_grid(surroundings.grid, state.theme, sheet.floor_lines);
  if (state.show_trail) add_trails(state, sheet.trails);
  add_lines_on_top(state, sheet.lines_on_top);
  if (state.show_joints) add_joints(arm, state.proxy, state.theme, sheet.lines_on_top);
  const Marks marks = collect_marks(state, eye, painter.pixel_scale() * scale);
  const double mpp = eye.meters_per_pixel(state.proxy.tip) / painter.pixel_scale();
  const std::vector<Ghost> ghosts = ghosts_of(state, mpp);
  const Links bodies = body_links(state.bodies, items.starts);
  const std::vector<BodyGhosts> others = body_ghosts(state, items.starts, mpp);

  painter.begin_frame(lighting, eye);
  painter.draw_shadows(proxy, bodies);
  if (sheet.target.begin(columns, rows, painter.quality().msaa) ||
      sheet.still != Still{state.theme, state.show_grid})
    sheet.damage.spoil();
  sheet.still = {state.theme, state.show_grid};
  sheet.damage.begin(to_glm(DrawnSheet::matrix_of(eye)), columns, rows);
  painter.note(proxy, true, sheet.damage);
  painter.note_bodies(bodies, sheet.damage);
  for (const BodyGhosts& other : others) painter.note(other, sheet.damage);
  for (const Ghost& ghost : ghosts) painter.note(ghost, sheet.damage);
  painter.note(sheet.trails, sheet.damage);
  painter.note(sheet.lines_on_top, sheet.damage);
  painter.note(marks, sheet.damage);
  const PixelArea changed = sheet.damage.end();
  if (changed.isEmpty()) return changed;

  painter.limit(changed, sheet.damage.whole());
  sheet.target.clear(area_of(changed));
  painter.draw_solid(lighting, proxy, bodies);
  painter.draw_shades(marks);
  painter.draw_lines(sheet.floor_lines, false);
  painter.draw_glass(proxy);
  for (const BodyGhosts& other : others) painter.draw_body_ghosts(other);
  for (std::size_t i = 0; i < ghosts.size(); ++i) painter.draw_ghost(ghosts[i], i);
  painter.draw_marks(marks);
  painter.draw_lines(sheet.trails, false);
  painter.draw_lines(sheet.lines_on_top, true);
  return changed;
}

const Bounds& SceneView::bounds() const { return impl_->surroundings.bounds; }
const Bounds& SceneView::grid() const { return impl_->surroundings.grid; }
const Quality& SceneView::quality() const { return impl_->painter.quality(); }
void SceneView::set_quality(const Quality& quality) {
  impl_->painter.set_quality(quality);
  ++impl_->version;
}
void SceneView::set_pixel_scale(double scale) {
  if (static_cast<float>(scale) == static_cast<float>(impl_->painter.pixel_scale())) return;
  impl_->painter.set_pixel_scale(scale);
  ++impl_->version;
}

}  // namespace limpid
