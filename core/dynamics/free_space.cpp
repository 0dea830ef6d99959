#include "core/dynamics/free_space.h"

#include <cmath>

namespace limpid {
namespace {

// Planes closer to parallel than this do not make an edge [-], of a Gram determinant.
constexpr double kParallel = 1e-10;

}  // namespace

bool operator==(const FreeSpace::Active& a, const FreeSpace::Active& b) {
  if (a.count != b.count) return false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.count); ++i) {
    if (a.plane[i] != b.plane[i]) return false;
  }
  return true;
}

bool FreeSpace::add(const Vec3& normal, double offset) {
  if (count_ == kMostPlanes) return false;
  normals_[static_cast<std::size_t>(count_)] = normal;
  offsets_[static_cast<std::size_t>(count_)] = offset;
  ++count_;
  return true;
}

// x = c + sum of w_i n_i on all of the active planes.
bool FreeSpace::solve(const Vec3& c, const Active& active, Vec3& x, Vec3& weights) const {
  Vec3 gap = Vec3::Zero();
  Mat3 gram = Mat3::Identity();
  for (int i = 0; i < active.count; ++i) {
    const int p = active.plane[static_cast<std::size_t>(i)];
    gap[i] = offset(p) - normal(p).dot(c);
    for (int j = 0; j < active.count; ++j) {
      gram(i, j) = normal(p).dot(normal(active.plane[static_cast<std::size_t>(j)]));
    }
  }
  if (active.count == 1) {
    weights = gap;
  } else {
    const double determinant = gram.determinant();
    if (!(determinant > kParallel)) return false;
    weights = gram.inverse() * gap;
  }
  x = c;
  for (int i = 0; i < active.count; ++i) {
    x += weights[i] * normal(active.plane[static_cast<std::size_t>(i)]);
  }
  return true;
}

Vec3 FreeSpace::onto(const Vec3& c, const Active& active) const {
  Vec3 x = c, weights;
  return solve(c, active, x, weights) ? x : c;
}

bool FreeSpace::holds(const Vec3& x, const Active& except) const {
  for (int i = 0; i < count_; ++i) {
    bool skip = false;
    for (int k = 0; k < except.count; ++k) {
      skip = skip || except.plane[static_cast<std::size_t>(k)] == i;
    }
    if (!skip && normal(i).dot(x) < offset(i) - 1e-15 * (1 + std::abs(offset(i)))) return false;
  }
  return true;
}

// The one set of planes with which x is in the room and no plane pulls: at most 41 to try, and the
// first few nearly always do.
bool FreeSpace::project(const Vec3& c, Vec3& x, Active& active) const {
  active = {};
  x = c;
  if (holds(c, active)) return true;
  Vec3 weights;
  const auto fits = [&](const Active& a) {
    if (!solve(c, a, x, weights)) return false;
    for (int i = 0; i < a.count; ++i) {
      if (weights[i] < 0) return false;
    }
    return holds(x, a);
  };
  for (int i = 0; i < count_; ++i) {
    active = {{i, 0, 0}, 1};
    if (fits(active)) return true;
  }
  for (int i = 0; i < count_; ++i) {
    for (int j = i + 1; j < count_; ++j) {
      active = {{i, j, 0}, 2};
      if (fits(active)) return true;
    }
  }
  for (int i = 0; i < count_; ++i) {
    for (int j = i + 1; j < count_; ++j) {
      for (int k = j + 1; k < count_; ++k) {
        active = {{i, j, k}, 3};
        if (fits(active)) return true;
      }
    }
  }
  active = {};
  x = c;
  return false;
}

int FreeSpace::basis(const Active& active, Mat3& e) const {
  int rank = 0;
  for (int i = 0; i < active.count; ++i) {
    Vec3 out = normal(active.plane[static_cast<std::size_t>(i)]);
    for (int j = 0; j < rank; ++j) out -= e.col(j).dot(out) * e.col(j);
    const double length = out.norm();
    if (length * length > kParallel) e.col(rank++) = out / length;
  }
  return rank;
}

}  // namespace limpid
