#include "render/scene_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "render/camera.h"
#include "render/gl/gl_names.h"
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
    out.push_back({std::make_shared<const GpuModel>(item.model), to_glm(item.pose), item.link,
                   item.own_color});
  return out;
}

constexpr float kMargin = 6;      // of outlines and soft edges [px]
constexpr float kSoftTexels = 8;  // reach of a shadow's soft edge
constexpr float kLeastLight = 0.1f;

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

std::array<glm::vec3, 8> corners_of(const Eigen::AlignedBox3f& box, const glm::mat4& pose) {
  std::array<glm::vec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    const Eigen::Vector3f c = box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i));
    corners[i] = glm::vec3(pose * glm::vec4(c.x(), c.y(), c.z(), 1));
  }
  return corners;
}

// Returns the points of a body and of the end of its shadow on the floor, the lowest there is.
std::vector<glm::vec3> with_shadow(std::span<const glm::vec3> body, float floor, float soft) {
  std::vector<glm::vec3> hull(body.begin(), body.end());
  for (const glm::vec3& p : body) {
    const float fall = std::max(0.0f, p.z - floor) / std::max(kLeastLight, kToLight.z);
    const glm::vec3 end = p - fall * kToLight;
    for (const glm::vec2 off :
         {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(-1, 1), glm::vec2(1)})
      hull.push_back(end + glm::vec3(soft * off, 0));
  }
  return hull;
}

glm::vec4 srgb(const palette::Rgb& c) { return {c[0], c[1], c[2], 1}; }

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
  bodies_ = upload_all(items.bodies);
  walls_ = upload_all(items.walls);
  probes_ = upload_all(items.probes);
  still_shadows_ = false;
  textured_world_ = std::any_of(items.world.begin(), items.world.end(),
                                [](const Item& item) { return !item.model.images.empty(); });
}

void ScenePainter::set_meshes(const std::vector<PlacedMesh>& meshes) {
  decltype(uploaded_) uploaded;
  meshes_.clear();
  body_meshes_.clear();
  highlighted_.clear();
  for (const PlacedMesh& mesh : meshes) {
    auto& model = uploaded[mesh.model];
    if (!model) {
      const auto known = uploaded_.find(mesh.model);
      model =
          known != uploaded_.end() ? known->second : std::make_shared<const GpuModel>(*mesh.model);
    }
    auto& list = mesh.body < 0 ? meshes_ : body_meshes_;
    list.push_back({model, mesh.pose, mesh.body});
    if (mesh.highlighted) highlighted_.push_back(list.back());
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

void ScenePainter::begin_frame(const Lighting& lighting, const Camera& camera) {
  lit_->shadow.aim(bounds_, kToLight);
  const glm::vec2 size(camera.width(), camera.height());
  seen_ = view_ = to_glm(Eigen::Matrix4d(camera.projection() * camera.view()));
  pixels_ = size.x * size.y;
  coarse_ = too_many_triangles();
  const FrameBlock block{view_,
                         lit_->shadow.lookup(),
                         glm::vec4(to_glm(camera.eye()), 1),
                         glm::vec4(kToLight, lit_->shadow.texel()),
                         lighting.key,
                         lighting.sky,
                         lighting.earth,
                         lighting.ground,
                         lighting.top,
                         lighting.bottom,
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
  // The floor lies a tenth of a millimetre lower, so that what stands on it wins.
  floor[3] = glm::vec4(bounds_.center().x(), bounds_.center().y(), ground_height_ - 1e-4f, 1);
  ground.set("model", floor);
  patch_.draw();
}

// Marks the arm with stencil 2: a ghost behind it stays hidden, one behind the scene shines
// through.
void ScenePainter::draw_solid(const Lighting& lighting, const Links& proxy, const Links& bodies) {
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
      .tint = lighting.object_tint, .matte = cheap, .coarse = coarse_, .pixels = pixels_};
  const LitPass::Look mesh{.coarse = coarse_, .pixels = pixels_};
  lit_->draw_solid(world_, {}, seen_, world);
  lit_->draw_solid(bodies_, bodies, seen_, world);
  lit_->draw_solid(meshes_, {}, seen_, mesh);
  lit_->draw_solid(body_meshes_, bodies, seen_, mesh);
  draw_ground();

  backdrop_.use();
  glBindVertexArray(no_vertices_);
  glDepthMask(GL_FALSE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_BLEND);
  lit_->draw_blended(world_, {}, seen_, world);
  lit_->draw_blended(meshes_, {}, seen_, mesh);
  lit_->draw_blended(body_meshes_, bodies, seen_, mesh);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDisable(GL_STENCIL_TEST);
  draw_outlines(lighting, bodies);
}

// Shows the inside of a slightly larger copy around the edge of what is highlighted.
void ScenePainter::draw_outlines(const Lighting& lighting, const Links& bodies) const {
  if (highlighted_.empty()) return;
  glCullFace(GL_FRONT);
  outline_.use();
  outline_.set("tint", lighting.outline);
  outline_.set("width", 2.5f);
  each(highlighted_, bodies, [&](const GpuModel& model, const glm::mat4& pose) {
    outline_.set("model", pose);
    model.draw(coarse_);
  });
  glCullFace(GL_BACK);
}

void ScenePainter::add_to(Damage& damage, const GpuModel& model, const glm::mat4& pose,
                          bool shadow) const {
  const auto body = corners_of(model.box(), pose);
  if (shadow && quality_.shadow_size > 0) {
    const float soft = kSoftTexels * lit_->shadow.texel();
    damage.add(bytes_of(pose), with_shadow(body, ground_height_ - soft, soft),
               kMargin * pixel_scale_);
  } else {
    damage.add(bytes_of(pose), body, kMargin * pixel_scale_);
  }
}

void ScenePainter::note_bodies(const Links& bodies, Damage& damage) const {
  for (const auto* list : {&bodies_, &body_meshes_}) {
    each(*list, bodies,
         [&](const GpuModel& model, const glm::mat4& pose) { add_to(damage, model, pose, true); });
  }
}

// Names hidden ghosts, too, with nothing around them: the order stays.
void ScenePainter::note(const BodyGhosts& ghosts, Damage& damage) const {
  for (const auto* list : {&bodies_, &body_meshes_}) {
    for (const Drawable& item : *list) {
      if (!ghosts.has(item.link)) {
        damage.add({}, {}, 0);
        continue;
      }
      const glm::mat4 pose = ghosts.links[static_cast<std::size_t>(item.link)] * item.pose;
      add_to(damage, *item.model, pose, false);
    }
  }
}

void ScenePainter::note(const Links& links, bool casts, Damage& damage) const {
  const auto add = [&](const GpuModel& model, const glm::mat4& pose) {
    add_to(damage, model, pose, casts);
  };
  each(moving_, links, add);
  if (!casts) return;
  each(walls_, links, add);
  each(probes_, links, add);
}

void ScenePainter::note(const Ghost& ghost, Damage& damage) const {
  const auto& [links, color, outline] = ghost;
  struct Look {
    glm::mat4 pose;
    palette::Rgb color;
    float outline;
  };
  for (const Drawable& item : moving_) {
    const auto link = static_cast<std::size_t>(item.link);
    if (link >= links.size()) continue;
    const glm::mat4 pose = links[link] * item.pose;
    damage.add(bytes_of(Look{pose, color, link < outline.size() ? outline[link] : 0}),
               corners_of(item.model->box(), pose), kMargin * pixel_scale_);
  }
}

void ScenePainter::note(const Marks& marks, Damage& damage) const {
  const Eigen::AlignedBox3f unit(Eigen::Vector3f(-1, -1, -1), Eigen::Vector3f(1, 1, 1));
  for (const SolidMark& mark : marks.solids)
    damage.add(bytes_of(mark), corners_of(unit, mark.place), 2);
  for (const SolidMark& mark : marks.glass)
    damage.add(bytes_of(mark), corners_of(unit, mark.place), 2);
  for (const glm::mat4& place : marks.shades)
    damage.add(bytes_of(place), corners_of(unit, place), 2);
  for (const FlashMark& mark : marks.flashes)
    damage.add(bytes_of(mark), corners_of(unit, mark.place), 2);
}

void ScenePainter::note(const LineBatch& lines, Damage& damage) const {
  std::vector<glm::vec3> ends;
  float widest = 0;
  for (const LineBatch::Line& line : lines.lines()) {
    ends.insert(ends.end(), {line.from, line.to});
    widest = std::max(widest, line.width);
  }
  damage.add(std::as_bytes(std::span(lines.lines())), ends, pixel_scale_ * widest + 2);
}

void ScenePainter::draw_still_shadows() const {
  lit_->shadow.begin_still();
  const auto draw_one = [&](const GpuModel& model, const glm::mat4& pose) {
    const glm::mat4 to_clip = lit_->shadow.clip() * pose;
    if (!in_sight(model.box(), to_clip)) return;
    depth_only_.set("model_to_clip", to_clip);
    model.draw(true);  // a shadow's edge is not that sharp
  };
  each(base_, {}, draw_one);
  each(world_, {}, draw_one);
  glDisable(GL_CULL_FACE);  // meshes may be open sheets
  each(meshes_, {}, draw_one);
  glEnable(GL_CULL_FACE);
}

void ScenePainter::draw_shadows(const Links& proxy, const Links& bodies) {
  if (quality_.shadow_size <= 0) return;
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 3.0f);
  depth_only_.use();
  if (!still_shadows_) {
    draw_still_shadows();
    shadow_damage_.spoil();
    still_shadows_ = true;
  }
  const ShadowMap& map = lit_->shadow;
  shadow_damage_.begin(map.clip(), map.size(), map.size());
  const auto each_caster = [&](auto&& draw_one) {
    each(moving_, proxy, draw_one);
    each(bodies_, bodies, draw_one);
    glDisable(GL_CULL_FACE);  // meshes may be open sheets
    each(body_meshes_, bodies, draw_one);
    glEnable(GL_CULL_FACE);
  };
  each_caster([&](const GpuModel& model, const glm::mat4& pose) {
    shadow_damage_.add(bytes_of(pose), corners_of(model.box(), pose), 2);
  });
  if (const PixelArea area = shadow_damage_.end(); !area.isEmpty()) {
    map.begin_moving(area);
    glEnable(GL_SCISSOR_TEST);
    glScissor(area.min().x(), area.min().y(), area.sizes().x(), area.sizes().y());
    const glm::mat4 clip = cropped(map.clip(), area, shadow_damage_.whole());
    each_caster([&](const GpuModel& model, const glm::mat4& pose) {
      if (!in_sight(model.box(), clip * pose)) return;
      depth_only_.set("model_to_clip", map.clip() * pose);
      model.draw(true);
    });
    glDisable(GL_SCISSOR_TEST);
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
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

// Draws around the ghost's visible part, and around the part that the scene hides.
void ScenePainter::draw_ghost_outline(const Ghost& ghost, int mark) const {
  const Links& links = ghost.links;
  const palette::Rgb& color = ghost.color;
  const std::vector<float>& outline = ghost.outline;
  glCullFace(GL_FRONT);
  outline_.use();
  // A thinner line would come and go with one sample a pixel.
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
  // The ghost lies a little behind its place, so that a proxy at the same place wins without
  // flicker.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.0f, 8.0f);
  // A first pass draws its depth alone, so that only the outermost surface shows; the stencil marks
  // it with a number.
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, mark, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  draw_translucent(ghost_depth_, moving_, links, color, {});
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_BLEND);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  draw_translucent(ghost_, moving_, links, color, {0.36f, 1.0f});
  // A last pass draws faintly the part that the scene hides, each pixel once.
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

void ScenePainter::draw_body_ghosts(const BodyGhosts& ghosts) {
  if (ghosts.shown.empty()) return;
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  ghost_.use();
  ghost_.set("tint", srgb(ghosts.color));
  ghost_.set("alpha", glm::vec2(0.25f, 0.75f));
  for (const auto* list : {&bodies_, &body_meshes_}) {
    for (const Drawable& item : *list) {
      if (!ghosts.has(item.link)) continue;
      ghost_.set("model", ghosts.links[static_cast<std::size_t>(item.link)] * item.pose);
      item.model->draw();
    }
  }
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

// Draws on the scene alone: what is marked in the stencil stands before it.
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
