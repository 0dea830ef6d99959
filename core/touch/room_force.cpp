#include "core/touch/room_force.h"

#include <Eigen/LU>
#include <algorithm>

namespace limpid {
namespace {

constexpr int kMostSteps = 10;    // steps of Newton's method; two or three are usual
constexpr double kStep = 1e-6;    // of a difference, relative to the segment
constexpr int kFinest = 1 << 10;  // parts of a segment: finest search for changes of planes

// State of the room at a point of the segment.
struct Held {
  Vec3 pull;               // from the point to the nearest free place [m]
  FreeSpace::Active by{};  // the planes
  Vec3 weights;            // weight of each plane
};

// Means over the segment from s = 0 to 1.
struct Mean {
  Vec3 pull = Vec3::Zero();    // [m]
  Mat3 damped = Mat3::Zero();  // factor of the damper on a velocity [-]
  Mat3 later = Mat3::Zero();   // slope of the pull's mean over the segment's end [-]
  bool one_plane = true;       // holds all of it, or none: then the damper's factor is constant
};

class Segment {
 public:
  Segment(const FreeSpace& space, const Vec3& from, const Vec3& D)
      : space_(space), from_(from), D_(D) {}

  Mean mean() const {
    Mean m;
    const Held a = at(0), b = at(1);
    add(0, kFinest, a, b, m);
    return m;
  }

 private:
  Held at(double s) const {
    const Vec3 c = from_ + s * D_;
    Held h;
    Vec3 x;
    space_.project(c, x, h.by, h.weights);
    h.pull = x - c;
    return h;
  }

  Mat3 projection(const FreeSpace::Active& by) const {
    Mat3 e;
    const int rank = space_.basis(by, e);
    return e.leftCols(rank) * e.leftCols(rank).transpose();
  }

  // Damper of the planes that hold. Each damps along its normal as a wall by itself does. Planes
  // that face nearly the same way share it, in proportion to their part of the depth below them. So
  // the crease between two faces of a valley drags no more than the faces do.
  Mat3 damper(const Held& h) const {
    Mat3 D = Mat3::Zero();
    for (int i = 0; i < h.by.count; ++i) {
      const Vec3& n = space_.normal(h.by.plane[static_cast<std::size_t>(i)]);
      if (h.by.count == 1) return n * n.transpose();
      const double depth = n.dot(h.pull);
      if (depth > 0) D += std::min(h.weights[i] / depth, 1.0) * n * n.transpose();
    }
    return D;
  }

  // Adds a part of the segment: the pull is linear between two places that the same planes hold.
  void add(int first, int last, const Held& a, const Held& b, Mean& m) const {
    const double s0 = static_cast<double>(first) / kFinest;
    const double s1 = static_cast<double>(last) / kFinest;
    if (last - first > 1) {
      const int half = (first + last) / 2;
      const Held middle = at(0.5 * (s0 + s1));
      if (!(a.by == b.by && a.by == middle.by)) {
        m.one_plane = false;
        add(first, half, a, middle, m);
        add(half, last, middle, b, m);
        return;
      }
    }
    m.one_plane = m.one_plane && a.by == b.by && a.by.count <= 1;
    m.pull += 0.5 * (s1 - s0) * (a.pull + b.pull);
    for (const Held* h : {&a, &b}) {
      m.damped += 0.5 * (s1 - s0) * damper(*h);
      m.later += 0.25 * (s1 * s1 - s0 * s0) * projection(h->by);
    }
  }

  const FreeSpace& space_;
  Vec3 from_, D_;
};

Mean mean_of(const Room& room, const Vec3& center, const Vec3& D) {
  if (!room.held()) return Segment(room.space(), center, D).mean();
  return {room.anchor() - center - 0.5 * D, Mat3::Identity(), 0.5 * Mat3::Identity()};
}

// Slope of the damper's way, m.damped D, over D. By differences, where planes share the damper.
Mat3 damped_on(const Room& room, const Vec3& center, const Vec3& D, const Mean& m) {
  const double step = kStep * D.norm();
  if (m.one_plane || !(step > 0)) return m.damped;
  Mat3 slope;
  for (int i = 0; i < 3; ++i) {
    const Vec3 there = D + step * Vec3::Unit(i);
    slope.col(i) = (mean_of(room, center, there).damped * there - m.damped * D) / step;
  }
  return slope;
}

}  // namespace

void room_force(const Room& room, const RoomTick& tick, Vec3& F) {
  const double b = tick.B / tick.T;
  Vec3 pull = Vec3::Zero();
  for (int i = 0; i < kMostSteps; ++i) {
    const Vec3 D = tick.a + tick.W * F;
    const Mean m = mean_of(room, tick.center, D);
    const Vec3 wanted = tick.K * m.pull - b * (m.damped * D);
    const Mat3 slope = Mat3::Identity() + (tick.K * m.later + b * m.damped) * tick.W;
    const Vec3 step = slope.inverse() * (wanted - F);
    F += step;
    pull = m.pull;
    if (step.squaredNorm() <= 1e-20 * (1 + F.squaredNorm())) break;
  }
  if (F.dot(pull) <= 0) F.setZero();  // walls do not stick
}

Vec3 room_push(const Room& room, const RoomTick& tick, Slope slope, Mat3& on_D) {
  const double b = tick.B / tick.T;
  const Mean m = mean_of(room, tick.center, tick.a);
  Vec3 F = tick.K * m.pull - b * (m.damped * tick.a);
  const bool pushes = F.dot(m.pull) > 0;
  on_D.setZero();
  if (!pushes) return Vec3::Zero();
  const bool whole = slope == Slope::whole;
  on_D = -tick.K * m.later - b * (whole ? damped_on(room, tick.center, tick.a, m) : m.damped);
  return F;
}

}  // namespace limpid
