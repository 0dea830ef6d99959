#include "app/desktop/panels/selection_outline.h"

#include <numbers>

#include "app/style/theme.h"

namespace limpid {
namespace {

class Pen {
 public:
  Pen(const Camera& camera, ScreenRect view, ImDrawList& list)
      : camera_(camera), view_(view), list_(list) {}

  void line(const Vec3& from, const Vec3& to) {
    const auto a = camera_.project(from), b = camera_.project(to);
    if (!a || !b) return;
    const auto at = [&](const Eigen::Vector2d& p) {
      return ImVec2(view_.min.x + static_cast<float>(p.x()),
                    view_.min.y + static_cast<float>(p.y()));
    };
    list_.AddLine(at(*a), at(*b), colour(current_palette().accent), 1.6f * current_scale());
  }

  void circle(const Vec3& middle, const Vec3& u, const Vec3& v) {
    constexpr int kCorners = 64;
    Vec3 before = middle + u;
    for (int i = 1; i <= kCorners; ++i) {
      const double angle = 2 * std::numbers::pi * i / kCorners;
      const Vec3 next = middle + std::cos(angle) * u + std::sin(angle) * v;
      line(before, next);
      before = next;
    }
  }

 private:
  const Camera& camera_;
  ScreenRect view_;
  ImDrawList& list_;
};

}  // namespace

void draw_outline(const SceneObject& object, const Camera& camera, ScreenRect view,
                  ImDrawList& list) {
  list.PushClipRect(view.min, view.max, true);
  Pen pen(camera, view, list);
  if (const auto* plane = std::get_if<Plane>(&object)) {
    const Vec3 u = plane->normal.unitOrthogonal();
    const Vec3 v = plane->normal.cross(u);
    pen.circle(plane->point, 0.03 * u, 0.03 * v);
    pen.line(plane->point, plane->point + 0.03 * plane->normal);
  } else if (const auto* sphere = std::get_if<Sphere>(&object)) {
    pen.circle(sphere->center, sphere->radius * camera.right(), sphere->radius * camera.up());
  } else if (const auto* box = std::get_if<Box>(&object)) {
    const auto corner = [&](int i) {
      const Vec3 sign(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
      return Vec3(box->pose * sign.cwiseProduct(box->size));
    };
    for (int i = 0; i < 8; ++i) {
      for (const int bit : {1, 2, 4}) {
        if ((i & bit) == 0) pen.line(corner(i), corner(i | bit));
      }
    }
  }
  list.PopClipRect();
}

}  // namespace limpid
