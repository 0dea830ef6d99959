#include "render/damage.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "render/marks.h"

namespace limpid {

namespace {

constexpr double kSpan = 0.3;    // length of a link, whose end turning moves [m]
constexpr double kFlash = 0.25;  // a contact's first moment [s]

// Compares values within a tolerance; a value that is not a number is never near.
struct Near {
  double tolerance;

  bool operator()(const Vec3& a, const Vec3& b) const { return (a - b).norm() <= tolerance; }
  bool operator()(const std::array<Vec3, 2>& a, const std::array<Vec3, 2>& b) const {
    return (*this)(a[0], b[0]) && (*this)(a[1], b[1]);
  }
  bool forces(const Vec3& a, const Vec3& b) const {
    return kMetersPerNewton * (a - b).norm() <= tolerance;
  }
  bool turns(const std::optional<Mat3>& a, const std::optional<Mat3>& b) const {
    return a.has_value() == b.has_value() && (!a || kPenLength * (*a - *b).norm() <= tolerance);
  }
  bool operator()(const Pose& a, const Pose& b) const {
    return (*this)(Vec3(a.translation()), Vec3(b.translation())) &&
           kSpan * (a.linear() - b.linear()).norm() <= tolerance;
  }
  bool operator()(const ContactMark& a, const ContactMark& b) const {
    return (*this)(a.position, b.position) && forces(a.force, b.force) &&
           (a.age == b.age || std::min(a.age, b.age) > kFlash) &&
           kSpan * (a.normal - b.normal).norm() <= tolerance && a.friction == b.friction &&
           a.slips == b.slips;
  }
  bool operator()(const ContactShade& a, const ContactShade& b) const {
    return (*this)(a.position, b.position) && std::abs(a.height - b.height) <= tolerance;
  }
  bool operator()(const OtherRun& a, const OtherRun& b) const {
    return (*this)(a.device, b.device) && (*this)(a.proxy, b.proxy) &&
           forces(a.hand_force, b.hand_force) && (*this)(a.contacts, b.contacts) &&
           (*this)(a.bodies, b.bodies);
  }
  template <class T>
  bool operator()(const std::vector<T>& a, const std::vector<T>& b) const {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), *this);
  }
  template <class T>
  bool operator()(const std::optional<T>& a, const std::optional<T>& b) const {
    return a.has_value() == b.has_value() && (!a || (*this)(*a, *b));
  }
  // Trails have a point a frame: those of a tip at rest are the same with any number of points.
  bool trails(const ArmPose& a, const ArmPose& b) const {
    return (*this)(a.trail, b.trail) || (rests(a) && rests(b));
  }
  bool rests(const ArmPose& arm) const {
    return std::ranges::all_of(arm.trail, [&](const Vec3& p) { return (*this)(p, arm.tip); });
  }
  bool operator()(const ArmPose& a, const ArmPose& b) const {
    return (*this)(a.tip, b.tip) && (*this)(a.links, b.links) && trails(a, b);
  }
};

}  // namespace

bool same_picture(const ViewState& a, const ViewState& b, double tolerance) {
  const Near near{tolerance};
  const auto switches = [](const ViewState& s) {
    return std::tuple(s.show_hand, s.hand_grips, s.show_ghost, s.show_error, s.show_trail,
                      s.show_forces, s.show_grid, s.show_joints, s.theme, s.magnet, s.magnet_holds);
  };
  const bool hands = !(a.show_hand && b.show_hand) || near(a.hand_target, b.hand_target);
  return switches(a) == switches(b) && near(a.device, b.device) && near(a.proxy, b.proxy) &&
         near(a.rerun, b.rerun) && near(a.beside, b.beside) && hands &&
         near.forces(a.hand_force, b.hand_force) && near(a.contacts, b.contacts) &&
         near(a.shade, b.shade) && near(a.pull, b.pull) && near(a.bodies, b.bodies) &&
         near(a.rerun_bodies, b.rerun_bodies) && near.turns(a.tool, b.tool);
}

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
