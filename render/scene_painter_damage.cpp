#include <array>

#include "render/frustum.h"
#include "render/scene_painter.h"

namespace limpid {
namespace {

constexpr float kMargin = 6;      // of outlines and soft edges [px]
constexpr float kSoftTexels = 8;  // how far a shadow's soft edge reaches
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

// What lies between a body and the end of its shadow on the floor, which is the lowest there is.
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

}  // namespace

void ScenePainter::note(const Links& links, bool casts, Damage& damage) const {
  const bool shadow = casts && quality_.shadow_size > 0;
  const float soft = kSoftTexels * lit_->shadow.texel();
  const auto add = [&](const GpuModel& model, const glm::mat4& pose) {
    const auto body = corners_of(model.box(), pose);
    if (shadow) {
      damage.add(bytes_of(pose), with_shadow(body, ground_height_ - soft, soft),
                 kMargin * pixel_scale_);
    } else {
      damage.add(bytes_of(pose), body, kMargin * pixel_scale_);
    }
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

void ScenePainter::draw_shadows(const Links& proxy) {
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
  each(moving_, proxy, [&](const GpuModel& model, const glm::mat4& pose) {
    shadow_damage_.add(bytes_of(pose), corners_of(model.box(), pose), 2);
  });
  if (const PixelArea area = shadow_damage_.end(); !area.isEmpty()) {
    map.begin_moving(area);
    glEnable(GL_SCISSOR_TEST);
    glScissor(area.min().x(), area.min().y(), area.sizes().x(), area.sizes().y());
    const glm::mat4 clip = cropped(map.clip(), area, shadow_damage_.whole());
    each(moving_, proxy, [&](const GpuModel& model, const glm::mat4& pose) {
      if (!in_sight(model.box(), clip * pose)) return;
      depth_only_.set("model_to_clip", map.clip() * pose);
      model.draw(true);
    });
    glDisable(GL_SCISSOR_TEST);
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
}

}  // namespace limpid
