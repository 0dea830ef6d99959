#include "core/dynamics/arm.h"

namespace limpid {

// An axis is carried along by the links before it, S_j' = V x S_j.
template <int N>
Vec3 Arm<N>::point_drift(const Frames& f, int link, const Vec3& world, const Vec<N>& v) const {
  Vec3 turning = Vec3::Zero(), moving = Vec3::Zero();  // V of the links before
  Vec3 drift = Vec3::Zero();
  for (int j = 0; j <= link; ++j) {
    const Vec3& a = f.a[static_cast<std::size_t>(j)];
    const Vec3& o = f.o[static_cast<std::size_t>(j)];
    drift += v[j] * (turning.cross(o) + moving.cross(a) + turning.cross(a).cross(world));
    moving += v[j] * o;
    turning += v[j] * a;
  }
  return drift + turning.cross(moving + turning.cross(world));
}

template Vec3 Arm<3>::point_drift(const Frames& f, int link, const Vec3& world,
                                  const Vec<3>& v) const;
template Vec3 Arm<kAnyDof>::point_drift(const Frames& f, int link, const Vec3& world,
                                        const Vec<kAnyDof>& v) const;

}  // namespace limpid
