// Pairs of numbers side by side in one register, so that two arms of one make cost as much as one;
// symmetric matrices of either.
#pragma once

#include "core/math/sizes.h"

namespace limpid {

struct Pair {
  typedef double Both __attribute__((vector_size(16)));

  Pair() = default;
  Pair(double of_both) : both{of_both, of_both} {}
  Pair(double first, double second) : both{first, second} {}

  double operator[](int i) const { return both[i]; }
  explicit operator double() const { return both[0]; }

  Pair& operator+=(const Pair& b) { return both += b.both, *this; }
  Pair& operator-=(const Pair& b) { return both -= b.both, *this; }
  Pair& operator*=(const Pair& b) { return both *= b.both, *this; }
  Pair operator-() const { return Pair(-both); }
  friend Pair operator+(const Pair& a, const Pair& b) { return Pair(a.both + b.both); }
  friend Pair operator-(const Pair& a, const Pair& b) { return Pair(a.both - b.both); }
  friend Pair operator*(const Pair& a, const Pair& b) { return Pair(a.both * b.both); }
  friend Pair operator/(const Pair& a, const Pair& b) { return Pair(a.both / b.both); }

 private:
  explicit Pair(const Both& b) : both(b) {}
  Both both;
};

template <class S>
using Vec3Of = Eigen::Matrix<S, 3, 1>;
template <class S>
using Mat3Of = Eigen::Matrix<S, 3, 3>;
template <int N, class S>
using VecOf = Eigen::Matrix<S, N, 1, 0, kCapacity<N>, 1>;
template <int N, class S>
using MatOf = Eigen::Matrix<S, N, N, 0, kCapacity<N>, kCapacity<N>>;
template <int N, class S>
using JacobianOf = Eigen::Matrix<S, 3, N, 0, 3, kCapacity<N>>;

// Makes one vector of pairs from two vectors.
template <int N>
VecOf<N, Pair> paired(const Vec<N>& first, const Vec<N>& second) {
  VecOf<N, Pair> both(first.size());
  for (Eigen::Index i = 0; i < both.size(); ++i) both[i] = Pair(first[i], second[i]);
  return both;
}
// Component `which` of a pair; a plain double is its own component.
inline double of(const Pair& both, int which) { return both[which]; }
inline double of(double one, int) { return one; }
template <class F>
Pair each(const Pair& both, const F& f) {
  return {f(both[0]), f(both[1])};
}
template <class F>
double each(double one, const F& f) {
  return f(one);
}
template <class Both, class One>
void take(const Both& both, int which, One& one) {
  one.resize(both.rows(), both.cols());
  for (Eigen::Index i = 0; i < both.size(); ++i) one.data()[i] = of(both.data()[i], which);
}

// Symmetric 3 x 3 matrices, six numbers each.
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

template <>
struct Eigen::NumTraits<limpid::Pair> : Eigen::GenericNumTraits<double> {
  using Real = limpid::Pair;
  using NonInteger = limpid::Pair;
  using Nested = limpid::Pair;
  using Literal = limpid::Pair;
};
