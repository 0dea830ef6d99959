// Random numbers, the same for a seed everywhere.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <random>
#include <span>

#include "core/math/elementary.h"
#include "core/math/sizes.h"

namespace limpid {

// A generator without the standard library's distributions, which differ between libraries.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967295.0;
  }
  // Uniform in the logarithm.
  double log_between(double low, double high) {
    return exponential(between(logarithm(low), logarithm(high)));
  }
  template <class T>
  T one_of(std::span<const T> values) {
    const double at = between(0, static_cast<double>(values.size()) - 1e-9);
    return values[static_cast<std::size_t>(at)];
  }
  template <class T>
  T one_of(std::initializer_list<T> values) {
    return one_of(std::span<const T>(values.begin(), values.size()));
  }
  Vec3 point(double size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }
  Vec3 direction() {
    Vec3 d = point(1);
    while (d.norm() < 0.1 || d.norm() > 1) d = point(1);
    return d.normalized();
  }
  Mat3 rotation() {
    const Vec3 axis = direction();
    const SineCosine half = sine_cosine(between(-3, 3) / 2);
    const Vec3 v = half.sine * axis;
    return Eigen::Quaterniond(half.cosine, v.x(), v.y(), v.z()).toRotationMatrix();
  }
  Eigen::VectorXd vector(int n, double size) {
    Eigen::VectorXd v(n);
    for (double& c : v) c = between(-size, size);
    return v;
  }

 private:
  std::mt19937 engine_;
};

}  // namespace limpid
