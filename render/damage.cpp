#include "render/damage.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace limpid {

void Damage::begin(const glm::mat4& to_clip, int width, int height) {
  const Eigen::Vector2i size(width, height);
  if (to_clip != to_clip_ || size != size_) spoilt_ = true;
  to_clip_ = to_clip;
  size_ = size;
  now_.clear();
}

PixelArea Damage::area_of(std::span<const glm::vec3> hull, float margin) const {
  PixelArea area;
  for (const glm::vec3& point : hull) {
    const glm::vec4 p = to_clip_ * glm::vec4(point, 1);
    if (!(p.w > 1e-4f)) return whole();  // behind the eye: anywhere
    const auto pixel = [](float clip, int size, float off) {
      const float at = 0.5f * (1 + clip) * static_cast<float>(size) + off;
      return static_cast<int>(std::clamp(std::floor(at), 0.0f, static_cast<float>(size)));
    };
    const float x = p.x / p.w, y = p.y / p.w;
    if (!std::isfinite(x) || !std::isfinite(y)) return whole();
    area.extend(Eigen::Vector2i(pixel(x, size_.x(), -margin), pixel(y, size_.y(), -margin)));
    area.extend(Eigen::Vector2i(pixel(x, size_.x(), margin + 1), pixel(y, size_.y(), margin + 1)));
  }
  return area;
}

void Damage::add(std::span<const std::byte> look, std::span<const glm::vec3> hull, float margin) {
  now_.push_back({hash_of(look), area_of(hull, margin)});
}

PixelArea Damage::end() {
  PixelArea area = spoilt_ ? whole() : PixelArea();
  for (std::size_t i = 0; !spoilt_ && i < std::max(now_.size(), before_.size()); ++i) {
    const bool both = i < now_.size() && i < before_.size();
    if (both && now_[i].look == before_[i].look) continue;
    if (i < now_.size()) area.extend(now_[i].where);
    if (i < before_.size()) area.extend(before_[i].where);
  }
  before_ = now_;
  spoilt_ = false;
  if (area.isEmpty() || area.sizes().minCoeff() < 1) return {};
  return area;
}

std::uint64_t hash_of(std::span<const std::byte> bytes) {
  std::uint64_t hash = 14695981039346656037u;
  for (const std::byte b : bytes) hash = (hash ^ static_cast<std::uint64_t>(b)) * 1099511628211u;
  return hash;
}

glm::mat4 cropped(const glm::mat4& to_clip, const PixelArea& area, const PixelArea& whole) {
  const Eigen::Vector2f all = whole.sizes().cast<float>();
  const Eigen::Vector2f scale = all.cwiseQuotient(area.sizes().cast<float>());
  const Eigen::Vector2f middle =
      (area.min() + area.max()).cast<float>().cwiseQuotient(all) - Eigen::Vector2f::Ones();
  const glm::mat4 grow = glm::scale(glm::mat4(1), glm::vec3(scale.x(), scale.y(), 1));
  return grow * glm::translate(glm::mat4(1), glm::vec3(-middle.x(), -middle.y(), 0)) * to_clip;
}

}  // namespace limpid
