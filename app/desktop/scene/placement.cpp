#include "app/desktop/scene/placement.h"

#include <cmath>
#include <limits>
#include <optional>

#include "render/scene_items.h"

namespace limpid {
namespace {

constexpr double kLeast = 0.02, kMost = 0.20, kHandy = 0.08;  // extents of a model [m]
constexpr double kClear = 0.012;                              // around a tip [m]
constexpr double kGap = 0.004;                                // between objects [m]

Bounds around(const Vec3& middle, const Vec3& size, double more) {
  const Vec3 half = size / 2 + Vec3::Constant(more);
  return {middle - half, middle + half};
}

// Returns a measure of how bad a place is; the least bad place is taken.
double badness(const Bounds& box, const Vec3& wanted, const Workplace& at) {
  double bad = (box.center() - wanted).head<2>().norm();
  const Bounds clear(box.min() - Vec3::Constant(kClear), box.max() + Vec3::Constant(kClear));
  for (const Vec3& tip : at.tips) bad += clear.contains(tip) ? 100 : 0;
  bad += clear.contains(at.rest) ? 100 : 0;
  const Bounds apart(box.min() - Vec3::Constant(kGap), box.max() + Vec3::Constant(kGap));
  for (const Bounds& other : at.taken) bad += apart.intersects(other) ? 1 : 0;
  // The arm reaches from its base to the tip.
  for (int i = 1; i < 8; ++i) {
    bad += box.contains(at.base + i / 8.0 * (at.rest - at.base)) ? 0.5 : 0;
  }
  const double far = (box.center() - at.base).norm() - 0.85 * at.reach;
  return bad + 20 * std::max(0.0, far);
}

}  // namespace

std::optional<double> table_height(const Scene& scene, const Vec3& rest) {
  std::optional<double> highest;
  for (const Object& object : scene.objects) {
    const auto* plane = std::get_if<Plane>(&object.shape);
    if (plane == nullptr || plane->normal.z() <= 0.99) continue;
    const double height = object.pose.translation().z();
    if (height < rest.z() && height > highest.value_or(-1e9)) highest = height;
  }
  return highest;
}

Vec3 find_place(const Vec3& size, std::optional<double> table, const Workplace& at) {
  Vec3 forward = at.rest - at.base;
  forward.z() = 0;
  forward = forward.norm() > 1e-6 ? Vec3(forward.normalized()) : Vec3(Vec3::UnitX());
  const Vec3 left = Vec3::UnitZ().cross(forward);
  Vec3 wanted = at.rest + 0.01 * forward;
  wanted.z() = table ? *table + size.z() / 2 : at.rest.z();
  Vec3 best = wanted;
  double least = std::numeric_limits<double>::infinity();
  const double room = 0.6 * at.reach + size.maxCoeff();
  const double step = room / 30;
  for (int i = -30; i <= 30; ++i) {
    for (int j = -30; j <= 30; ++j) {
      const Vec3 tried = wanted + step * (i * forward + j * left);
      const double bad = badness(around(tried, size, 0), wanted, at) + (i < 0 ? 0.01 : 0);
      if (bad < least) {
        least = bad;
        best = tried;
      }
    }
  }
  return best;
}

double handy_scale(double extent) {
  if (!(extent > 0) || !std::isfinite(extent) || (extent >= kLeast && extent <= kMost)) return 1;
  const double exact = kHandy / extent;
  const double digit = std::pow(10.0, std::floor(std::log10(exact)) - 1);
  return std::round(exact / digit) * digit;
}

void place_mesh(Object& object, const Bounds& model, const Scene& scene, const Workplace& at) {
  Mesh& mesh = std::get<Mesh>(object.shape);
  mesh.scale = handy_scale(mesh.unit * model.sizes().maxCoeff());
  const Pose unmoved = mesh.stood(Pose::Identity());
  const Bounds upright = moved(model, Eigen::Affine3d(unmoved) * Eigen::Scaling(mesh.size()));
  const Vec3 place = find_place(upright.sizes(), table_height(scene, at.rest), at);
  const Vec3 shift = place - upright.center();
  object.pose = pose_at((shift * 1e4).array().round() / 1e4);                   // to 0.1 mm
  if (table_height(scene, at.rest)) object.pose.translation().z() = shift.z();  // stands on it
}

}  // namespace limpid
