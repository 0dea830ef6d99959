#include "core/touch/joint_forces.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/elementary.h"
#include "core/touch/body_motion.h"
#include "core/touch/wall_force.h"

namespace limpid {
namespace {

constexpr double kZeta = 0.7;      // damping ratio without restitution
constexpr int kMostSteps = 30;     // steps of Newton's method; three to six are usual
constexpr double kEnough = 1e-13;  // relative to the radius

}  // namespace

double damping_ratio(double restitution) {
  if (restitution <= 0) return kZeta;
  const double log = logarithm(restitution);
  return std::min(kZeta, -log / std::sqrt(std::numbers::pi * std::numbers::pi + log * log));
}

double sweep_joint(const BodyJoint& joint, const JointPotential& potential, double T,
                   AlongJoint& along, JointForces& forces) {
  const double w = along.answer, c = T * w, s = along.place;
  double change = 0;
  const auto set = [&](double& force, double to) {
    along.speed += w * (to - force);
    change += std::abs(to - force);
    force = to;
  };
  if (potential.any()) {
    double F = forces.potential;
    potential.over_a_tick(s, T * (along.speed - w * forces.potential), c, F);
    set(forces.potential, F);
  }
  // The stop that is pressed, or else the one ahead: a quick joint may reach the further one.
  const bool within = joint.low <= s && s <= joint.high;
  const bool up = forces.hit.holds ? upper_is_nearer(joint, s)
                  : within         ? along.speed > w * forces.stop
                                   : s > joint.high;
  const double depth = up ? s - joint.high : joint.low - s;
  if (std::isfinite(depth) || forces.stop != 0) {
    const double m_eff = BodyMotion::kTheta * T / w;
    const double ratio = forces.hit.lossless ? 0 : damping_ratio(joint.stop_restitution);
    const double B = 2 * ratio * std::sqrt(joint.stop_stiffness * m_eff);
    const double sign = up ? -1 : 1;
    const double deeper = -sign * T * (along.speed - w * forces.stop);
    const double F = wall_force({joint.stop_stiffness, B, T, depth, deeper, c});
    set(forces.stop, sign * forces.hit.limited(F, deeper / T, sign, w));
  }
  if (joint.friction > 0) {
    const double K = joint.stop_stiffness;
    const double free = along.speed - w * forces.friction;
    const double l = -K * (forces.anchor + T * free) / (1 + K * c);
    set(forces.friction, std::clamp(l, -joint.friction, joint.friction));
  }
  return change;
}

double stored(const BodyJoint& joint, const JointPotential& potential, double place,
              double anchor) {
  const double d = std::max({0.0, joint.low - place, place - joint.high});
  return potential.energy(place) + 0.5 * joint.stop_stiffness * (d * d + anchor * anchor);
}

double made(const BodyJoint& joint, const JointPotential& potential, double T,
            const AlongJoint& along, const JointForces& forces) {
  const double way = T * along.speed, anchor = -forces.friction / joint.stop_stiffness;
  return forces.sum() * way + stored(joint, potential, along.place + way, anchor) -
         stored(joint, potential, along.place, forces.anchor);
}

// Outside the ball l solves (1 + K T W + m) l = -K (z + T b), m > 0 such that |l| is the radius.
// Newton's method on 1/|l| converges from below (More and Sorensen 1983).
Vec3 friction_torque(double K, double radius, const Vec3& z, double T, const Vec3& b,
                     const Mat3& W) {
  if (!(radius > 0)) return Vec3::Zero();
  const Mat3 stick = Mat3::Identity() + K * T * W;
  const Vec3 drive = -K * (z + T * b);
  Mat3 inverse = stick.inverse();
  Vec3 l = inverse * drive;
  double size = l.norm(), m = 0;
  if (size <= radius) return l;
  for (int i = 0; i < kMostSteps && size > radius * (1 + kEnough); ++i) {
    m += (size / radius - 1) * size * size / l.dot(inverse * l);
    inverse = (stick + m * Mat3::Identity()).inverse();
    l = inverse * drive;
    size = l.norm();
  }
  return radius / size * l;
}

}  // namespace limpid
