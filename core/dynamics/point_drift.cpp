#include "core/dynamics/arm.h"

namespace limpid {

// An axis is carried along by the links before it, S_j' = V x S_j.
template <int N>
template <class S>
Vec3Of<S> Arm<N>::point_drift(const FramesOf<S>& f, int link, const Vec3Of<S>& world,
                              const VecOf<N, S>& v) const {
  Vec3Of<S> turning = Vec3Of<S>::Zero(), moving = turning;  // V of the links before
  Vec3Of<S> drift = turning;
  for (int j = 0; j <= link; ++j) {
    const Vec3Of<S>& a = f.a[static_cast<std::size_t>(j)];
    const Vec3Of<S>& o = f.o[static_cast<std::size_t>(j)];
    drift += v[j] * (turning.cross(o) + moving.cross(a) + turning.cross(a).cross(world));
    moving += v[j] * o;
    turning += v[j] * a;
  }
  return drift + turning.cross(moving + turning.cross(world));
}

template Vec3Of<double> Arm<3>::point_drift(const FramesOf<double>&, int, const Vec3Of<double>&,
                                            const VecOf<3, double>&) const;
template Vec3Of<double> Arm<7>::point_drift(const FramesOf<double>&, int, const Vec3Of<double>&,
                                            const VecOf<7, double>&) const;
template Vec3Of<Pair> Arm<3>::point_drift(const FramesOf<Pair>&, int, const Vec3Of<Pair>&,
                                          const VecOf<3, Pair>&) const;
template Vec3Of<Pair> Arm<7>::point_drift(const FramesOf<Pair>&, int, const Vec3Of<Pair>&,
                                          const VecOf<7, Pair>&) const;
template Vec3Of<double> Arm<kAnyDof>::point_drift(const FramesOf<double>&, int,
                                                  const Vec3Of<double>&,
                                                  const VecOf<kAnyDof, double>&) const;
template Vec3Of<Pair> Arm<kAnyDof>::point_drift(const FramesOf<Pair>&, int, const Vec3Of<Pair>&,
                                                const VecOf<kAnyDof, Pair>&) const;

}  // namespace limpid
