// An orbiting camera, and what it or a light can see of boxes.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "core/math/sizes.h"

namespace limpid {

// Returns false only if the whole box, whose frame `to_clip` brings to clip space, lies beyond one
// side.
inline bool in_sight(const Eigen::AlignedBox3f& box, const glm::mat4& to_clip) {
  bool beyond[5] = {true, true, true, true, true};
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3f c = box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i));
    const glm::vec4 p = to_clip * glm::vec4(c.x(), c.y(), c.z(), 1);
    beyond[0] &= p.x < -p.w;
    beyond[1] &= p.x > p.w;
    beyond[2] &= p.y < -p.w;
    beyond[3] &= p.y > p.w;
    beyond[4] &= p.z < -p.w;
  }
  return !(beyond[0] || beyond[1] || beyond[2] || beyond[3] || beyond[4]);
}

// Returns the largest share of the view that a box may cover; more than 1 where it reaches beyond.
inline float share_of_view(const Eigen::AlignedBox3f& box, const glm::mat4& to_clip) {
  Eigen::AlignedBox2f covered;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3f c = box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i));
    const glm::vec4 p = to_clip * glm::vec4(c.x(), c.y(), c.z(), 1);
    if (!(p.w > 1e-4f)) return 1e9f;  // around the eye
    covered.extend(Eigen::Vector2f(p.x / p.w, p.y / p.w));
  }
  return 0.25f * covered.sizes().prod();
}

using Bounds = Eigen::AlignedBox3d;

struct Ray {
  Vec3 origin;
  Vec3 direction;  // unit
};

// An orbiting camera, z up. Pixels are counted from the top left corner of the viewport, y down.
class Camera {
 public:
  Camera();

  // Named views: front looks at the device from +x, side from -y, top from +z; iso from front,
  // right and above.
  enum class View { front, top, side, iso };

  // Size of the viewport in pixels, at least 1 x 1.
  void resize(double width, double height);

  // Moves by the mouse, in pixels. They act at once and end a transition under way.
  void orbit(double dx, double dy);
  void pan(double dx, double dy);
  // Zooms by notches of the wheel, positive closer; what is under the cursor stays there.
  void zoom(double steps, const Eigen::Vector2d& pixel);

  // Smooth moves, which advance() carries out. frame() shows all of `bounds` with room around.
  void look(View view);
  void frame(const Bounds& bounds);
  void reset(const Bounds& bounds);  // iso view of `bounds`
  void advance(double dt);           // [s]
  void finish();                     // jumps to the goal

  Vec3 eye() const;
  Vec3 target() const { return now_.target; }
  Vec3 forward() const;  // unit, into the picture: the direction of depth
  Vec3 right() const;    // unit
  Vec3 up() const;       // unit
  double distance() const { return now_.distance; }
  double width() const { return width_; }
  double height() const { return height_; }

  Eigen::Matrix4d view() const;
  Eigen::Matrix4d projection() const;  // OpenGL clip space

  // Returns nothing when the point is behind the eye.
  std::optional<Eigen::Vector2d> project(const Vec3& point) const;
  Ray ray(const Eigen::Vector2d& pixel) const;
  // Returns the point where the mouse ray meets the plane through `through` parallel to the image.
  Vec3 plane_drag(const Eigen::Vector2d& pixel, const Vec3& through) const;
  // Returns the size of one pixel at this point [m].
  double meters_per_pixel(const Vec3& point) const;
  // Returns the same eye looking at `about` through a lens, in another viewport: there `about`
  // appears `times` as large as here.
  Camera magnified(const Vec3& about, double times, double width, double height) const;

 private:
  struct Placement {
    Vec3 target = Vec3::Zero();
    double azimuth = -1.05;   // of the eye about z, from x [rad]
    double elevation = 0.42;  // of the eye above the horizon [rad]
    double distance = 0.9;    // [m]
  };
  void move_now(const Placement& placement);
  void go_to(const Placement& placement);

  Placement now_, from_, goal_;
  double progress_ = 1;  // of the transition from from_ to goal_, 0 to 1
  double width_ = 1280, height_ = 720;
  double tan_y_;  // tangent of half the vertical field of view
};

}  // namespace limpid
