#include "core/touch/free_space.h"

namespace limpid {

namespace {

// Angle between planes below which they make no edge [rad]: the one further out holds alone.
constexpr double kParallel = 1e-9;

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

// Extends an orthonormal basis E by the i-th active normal, with N = E R.
bool FreeSpace::extend(const Active& active, int i, Mat3& e, Mat3& r) const {
  Vec3 rest = normal(active.plane[static_cast<std::size_t>(i)]);
  r.col(i).setZero();
  for (int pass = 0; pass < (i > 0 ? 2 : 1); ++pass) {  // once more for nearly parallel ones
    for (int j = 0; j < i; ++j) {
      const double part = e.col(j).dot(rest);
      r(j, i) += part;
      rest -= part * e.col(j);
    }
  }
  r(i, i) = rest.norm();
  e.col(i) = rest / r(i, i);
  return r(i, i) > kParallel;
}

// Solves x = c + sum of w_i n_i on all of the active planes.
bool FreeSpace::solve(const Vec3& c, const Active& active, Vec3& x, Vec3& weights) const {
  Mat3 e, r;
  Vec3 along;
  x = c;
  for (int i = 0; i < active.count; ++i) {
    if (!extend(active, i, e, r)) return false;
    const int p = active.plane[static_cast<std::size_t>(i)];
    along[i] = (offset(p) - normal(p).dot(x)) / r(i, i);
    x += along[i] * e.col(i);
  }
  for (int i = active.count - 1; i >= 0; --i) {
    weights[i] = along[i];
    for (int j = i + 1; j < active.count; ++j) weights[i] -= r(i, j) * weights[j];
    weights[i] /= r(i, i);
  }
  return true;
}

Vec3 FreeSpace::onto(const Vec3& c, const Active& active) const {
  Vec3 x = c, weights;
  return solve(c, active, x, weights) ? x : c;
}

// True if x is in the room, up to rounding and planes that count as parallel.
bool FreeSpace::holds(const Vec3& c, const Vec3& x, const Active& except) const {
  const double slack = kParallel * (x - c).norm() + 1e-15 * x.lpNorm<1>();
  for (int i = 0; i < count_; ++i) {
    bool skip = false;
    for (int k = 0; k < except.count; ++k) {
      skip = skip || except.plane[static_cast<std::size_t>(k)] == i;
    }
    if (!skip && normal(i).dot(x) < offset(i) - slack) return false;
  }
  return true;
}

// Finds the one set of planes with which x is in the room and no plane pulls: at most 41 to try,
// and the first few nearly always suffice.
bool FreeSpace::project(const Vec3& c, Vec3& x, Active& active, Vec3& weights) const {
  active = {};
  x = c;
  if (holds(c, c, active)) return true;
  const auto fits = [&](const Active& a) {
    if (!solve(c, a, x, weights)) return false;
    for (int i = 0; i < a.count; ++i) {
      if (weights[i] < 0) return false;
    }
    return holds(c, x, a);
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
  Mat3 r;
  int rank = 0;
  while (rank < active.count && extend(active, rank, e, r)) ++rank;
  return rank;
}

}  // namespace limpid
