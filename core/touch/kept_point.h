// A point of a pair as numbers, so that a run goes on from it to the bit.
#pragma once

#include <btBulletCollisionCommon.h>

#include <span>
#include <vector>

#include "core/touch/body_geometry.h"

namespace limpid {

struct KeptPoint {
  static constexpr std::size_t kNumbers = 30;

  btManifoldPoint point;
  bool turned = false;  // Bullet has swapped the pair

  // Appends the numbers of a point and of its contact.
  static void write(const btManifoldPoint& point, bool turned, const BodyContact& contact,
                    std::vector<double>& into);
  // Takes the point from kNumbers numbers.
  explicit KeptPoint(std::span<const double> from);
  // Sets what is kept of a contact from the same numbers.
  static void read(std::span<const double> from, BodyContact& contact);
};

}  // namespace limpid
