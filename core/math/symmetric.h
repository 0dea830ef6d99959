// Symmetric 3 x 3 matrices, six numbers each.
#pragma once

#include "core/math/pair.h"

namespace limpid {

template <class S>
struct Symmetric3 {
  S xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  Symmetric3& operator+=(const Symmetric3& b) {
    xx += b.xx, yy += b.yy, zz += b.zz;
    xy += b.xy, xz += b.xz, yz += b.yz;
    return *this;
  }

  [[gnu::always_inline]] Vec3Of<S> operator*(const Vec3Of<S>& v) const {
    return {xx * v.x() + xy * v.y() + xz * v.z(), xy * v.x() + yy * v.y() + yz * v.z(),
            xz * v.x() + yz * v.y() + zz * v.z()};
  }
};

}  // namespace limpid
