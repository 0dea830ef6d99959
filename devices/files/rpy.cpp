#include "devices/files/rpy.h"

#include <cmath>
#include <numbers>

#include "core/math/elementary.h"

namespace limpid {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

// Angles near those of R. Near a pitch of 90 degrees only the sum of roll and yaw matters: yaw is
// left to round-off, and roll fits to it.
Vec3 nearby(const Mat3& R) {
  const double across = std::hypot(R(0, 0), R(1, 0));
  const double yaw = across < 1e-9 ? 0 : std::atan2(R(1, 0), R(0, 0));
  const auto [s, c] = sine_cosine(yaw);
  return {std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1)),
          std::atan2(-R(2, 0), across), yaw};
}

double half_turn_on(double angle) { return angle > 0 ? angle - kHalfTurn : angle + kHalfTurn; }

// The double `steps` after x, before it if negative; zero stays zero.
double further(double x, int steps) {
  if (x == 0) return 0;
  const double towards = steps < 0 ? -10 : 10;
  for (int i = 0; i < std::abs(steps); ++i) x = std::nextafter(x, towards);
  return x;
}

}  // namespace

Eigen::Quaterniond turn(double angle, const Vec3& axis) {
  const auto [s, c] = sine_cosine(angle / 2);
  return {c, s * axis.x(), s * axis.y(), s * axis.z()};
}

Eigen::Quaterniond turn(const Vec3& rpy) {
  return turn(rpy.z(), Vec3::UnitZ()) * turn(rpy.y(), Vec3::UnitY()) * turn(rpy.x(), Vec3::UnitX());
}

Mat3 rotation(const Vec3& rpy) { return turn(rpy).toRotationMatrix(); }

Vec3 rpy_of(const Mat3& R) {
  const Vec3 about = nearby(R);
  // Every rotation has a second set of angles, with a pitch beyond 90 degrees.
  const Vec3 beyond(half_turn_on(about.x()), half_turn_on(-about.y()), half_turn_on(about.z()));
  for (double scale = 1; scale < 1e16; scale *= 10) {
    for (const Vec3& exact : {about, beyond}) {
      const Vec3 rounded = (exact * scale).array().round() / scale;
      if (rotation(rounded) == R) return rounded + Vec3::Zero();  // no -0
    }
  }
  constexpr int kSteps = 2;  // units in the last place
  for (int far = 0; far <= kSteps; ++far) {
    for (int x = -far; x <= far; ++x) {
      for (int y = -far; y <= far; ++y) {
        for (int z = -far; z <= far; ++z) {
          const Vec3 tried(further(about.x(), x), further(about.y(), y), further(about.z(), z));
          if (rotation(tried) == R) return tried + Vec3::Zero();
        }
      }
    }
  }
  return about;
}

Mat3 settled(const Mat3& R) {
  const Vec3 rpy = rpy_of(R);
  const Mat3 written = rotation(rpy);
  if (written == R || rotation(rpy_of(written)) == written) return written;
  return rotation((rpy * 1e9).array().round() / 1e9);
}

}  // namespace limpid
