#include "core/dynamics/farthest_tip.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/dynamics/arm.h"

namespace limpid {
namespace {

using Any = Arm<kAnyDof>;
constexpr double kPi = std::numbers::pi;
constexpr int kMostStarts = 64;
constexpr int kMostSweeps = 100;      // over all joints, from one start
constexpr int kMostFrames = 100'000;  // frames times joints in all: bounds the time

class Climb {
 public:
  explicit Climb(const ArmDescription& description)
      : description_(description),
        arm_(description),
        from_(description.joints.front().origin.translation()) {}

  double distance(const Vec<kAnyDof>& x) const { return (arm_.tip_at(x) - from_).norm(); }

  // Moves one joint after the other to the position that is farthest for the tip, with the others
  // fixed. Returns how many frames it computed.
  int up(Vec<kAnyDof>& x) const {
    double before = distance(x);
    int looked = 1;
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      for (int i = arm_.dof(); i-- > 0;) best(i, x);
      looked += arm_.dof() + 1;
      const double now = distance(x);
      if (now <= before * (1 + 1e-10)) break;
      before = now;
    }
    return looked;
  }

 private:
  const Joint& joint(int i) const { return description_.joints[static_cast<std::size_t>(i)]; }

  void best(int i, Vec<kAnyDof>& x) const {
    Any::Frames f;
    arm_.frames(x, f);
    if (joint(i).kind == Joint::Kind::prismatic) {
      slide(i, x);
    } else {
      turn(i, f, x);
    }
  }

  // The distance is convex along a straight line: it is largest at an end.
  void slide(int i, Vec<kAnyDof>& x) const {
    const Joint& j = joint(i);
    if (!std::isfinite(j.lower) || !std::isfinite(j.upper)) return;
    Vec<kAnyDof> other = x;
    other[i] = j.lower;
    x[i] = j.upper;
    if (distance(other) > distance(x)) x = other;
  }

  // The tip moves on a circle with centre c; d leads from from_ to c, u from c to the tip. Turned
  // further by t, the squared distance is a constant and
  // 2 d.u cos t + 2 d.(a x u) sin t.
  void turn(int i, const Any::Frames& f, Vec<kAnyDof>& x) const {
    const auto k = static_cast<std::size_t>(i);
    const Vec3 a = f.a[k], r = arm_.tip(f) - f.p[k];
    const Vec3 u = r - a.dot(r) * a, d = f.p[k] - from_;
    const double along = d.dot(u), across = d.dot(a.cross(u));
    if (std::hypot(along, across) < 1e-14 * (1 + d.norm() * u.norm())) return;  // all the same
    const auto gain = [&](double t) { return along * std::cos(t) + across * std::sin(t); };
    const Joint& j = joint(i);
    const double top = std::atan2(across, along);
    double t = top + 2 * kPi * std::ceil((j.lower - x[i] - top) / (2 * kPi));
    if (!std::isfinite(t)) t = top;
    if (x[i] + t > j.upper) {  // out of the limits: the better limit
      const double down = j.lower - x[i], up = j.upper - x[i];
      t = gain(down) > gain(up) ? down : up;
    }
    if (gain(t) > gain(0)) x[i] = std::clamp(x[i] + t, j.lower, j.upper);
  }

  const ArmDescription& description_;
  Any arm_;
  Vec3 from_;
};

}  // namespace

FarthestTip farthest_tip(const ArmDescription& description) {
  const Climb climb(description);
  const int n = description.dof();
  std::mt19937 random(1);  // the same answer every time
  FarthestTip farthest;
  int looked = 0;
  for (int start = 0; start < kMostStarts && looked * n < kMostFrames; ++start) {
    Vec<kAnyDof> x = rest_pose(description);
    for (int i = 0; i < n && start > 0; ++i) {
      const Joint& joint = description.joints[static_cast<std::size_t>(i)];
      const bool slides = joint.kind == Joint::Kind::prismatic;
      const bool limited = std::isfinite(joint.lower) && std::isfinite(joint.upper);
      const double lower = limited ? joint.lower : slides ? 0 : -kPi;
      const double upper = limited ? joint.upper : slides ? 0 : kPi;
      x[i] = lower + (upper - lower) * static_cast<double>(random()) / 4294967295.0;
    }
    looked += climb.up(x);
    const double distance = climb.distance(x);
    if (start > 0 && distance <= farthest.distance) continue;
    farthest = {distance, x};
  }
  return farthest;
}

}  // namespace limpid
