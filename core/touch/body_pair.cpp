#include "core/touch/body_pair.h"

#include <algorithm>
#include <cmath>

#include "core/touch/joint_forces.h"

namespace limpid {
namespace {

constexpr double kFade = 0.05;     // time in which a depth that was not pressed in fades [s]
constexpr double kRise = 0.01;     // speed at which a body rises by that at most [m/s]
constexpr double kHeaviest = 1e6;  // mass of what cannot move along the normal [kg]
constexpr double kPlastic = 2;     // damping ratio of an impact without restitution: it sinks less

// F^T W F, number by number in the order of Eigen's sums.
void turn_into(const Mat3& F, const Mat3& W, Mat3& out) {
  for (int i = 0; i < 3; ++i) {
    double T[3];
    for (int j = 0; j < 3; ++j) {
      T[j] = F(0, i) * W(0, j) + (F(1, i) * W(1, j) + F(2, i) * W(2, j));
    }
    for (int j = 0; j < 3; ++j) out(i, j) = T[0] * F(0, j) + (T[1] * F(1, j) + T[2] * F(2, j));
  }
}

double stiffness(const BodyContact& contact, const Bodies& bodies) {
  const double one = bodies.about[Bodies::at(contact.a)].contact_stiffness;
  return contact.b == BodyContact::kStill
             ? one
             : std::min(one, bodies.about[Bodies::at(contact.b)].contact_stiffness);
}

}  // namespace

void BodyPair::prepare(Bodies& bodies) {
  BodyContact& c = *contact;
  const Vec3& normal = c.goes_on ? c.next_normal : c.normal;
  if (c.goes_on) {
    end_a = bodies.end_in_the_middle(a, c.next_point);
    end_b = bodies.end_in_the_middle(b, c.next_point);
  } else {
    end_a = bodies.end_at(a, c.point, c.round_a);
    end_b = bodies.end_at(b, c.point, c.round_b);
  }
  K = stiffness(c, bodies);
  frame.col(0) = normal;
  frame.col(1) = normal.unitOrthogonal();
  frame.col(2) = normal.cross(frame.col(1));
  Mat3 answer = bodies.answer(end_a);
  if (end_b.body != BodyContact::kStill) answer += bodies.answer(end_b);
  turn_into(frame, answer, W);
  fade(bodies);
  depth = c.depth - c.rest;
  const Material& one = bodies.objects[static_cast<std::size_t>(c.object_a)];
  const Material& two = bodies.objects[static_cast<std::size_t>(c.object_b)];
  const double kinetic = std::max(one.friction_kinetic, two.friction_kinetic);
  const double still = std::max(one.friction_static, two.friction_static);
  radius = c.slipping ? kinetic : std::max(still, kinetic);
  const auto of = [&](int body) {
    return body == BodyContact::kStill ? 0.0 : bodies.about[Bodies::at(body)].restitution;
  };
  restitution = std::max(of(a), of(b));
  c.impact.begin(c.force, -c.normal.dot(bodies.speed_at(a, c.point) - bodies.speed_at(b, c.point)));
  const double ratio = !c.impact.going() ? damping_ratio(restitution)
                       : restitution > 0 ? 0
                                         : kPlastic;
  B = 2 * ratio * std::sqrt(K * mass(bodies));
  // Turns the stored force to the contact's present frame first: a force that no row has would do
  // unaccounted work.
  force = c.force;
  friction.noalias() = frame.rightCols<2>().transpose() * c.friction;
  anchor.noalias() = frame.rightCols<2>().transpose() * c.anchor;
  if (radius == 0) friction.setZero();
  bodies.apply(end_a, end_b, force * c.normal + frame.rightCols<2>() * friction);
}

// Depth that was not pressed in fades, as fast as what the contact lost pays for it, and so slowly
// that it throws up no body.
void BodyPair::fade(const Bodies& bodies) {
  BodyContact& c = *contact;
  c.rest = std::max(0.0, c.depth - c.pressed);
  if (!(c.rest > 0)) return;
  const double d = std::max(0.0, c.depth - c.rest), T = bodies.T;
  const double paid = std::sqrt(d * d + 2 * std::max(0.0, c.lost) / K) - d;
  const double slow = kRise * std::min(T, std::sqrt(mass(bodies) / K));
  const double less = std::min({paid, c.rest * std::min(1.0, T / kFade), slow});
  c.rest -= less;
  c.lost -= K * less * (d + less / 2);
}

double BodyPair::solve(Bodies& bodies) {
  const double T = bodies.T;
  const Vec3 v = frame.transpose() * (bodies.velocity(end_a) - bodies.velocity(end_b));
  const double c = T * W(0, 0);
  const double F = wall_force({K, B, T, depth, -T * v.x() + c * force, c});
  const double change = F - force;
  force = F;
  bodies.apply(end_a, end_b, change * frame.col(0));
  if (radius == 0) return std::abs(change);
  const auto across = frame.rightCols<2>();
  const Mat2 W_across = W.bottomRightCorner<2, 2>();
  const Vec2 free =
      across.transpose() * (bodies.velocity(end_a) - bodies.velocity(end_b)) - W_across * friction;
  const Vec2 l = friction_force(K, radius * F, anchor, T, free, W_across);
  const Vec2 more = l - friction;
  friction = l;
  bodies.apply(end_a, end_b, across * more);
  return std::abs(change) + more.norm();
}

void BodyPair::add(Bodies& bodies, const Vec3& more) {
  force += more.x();
  friction += more.tail<2>();
  bodies.apply(end_a, end_b, frame * more);
}

void BodyPair::hold(const Bodies&) {
  force = contact->force;
  friction = frame.rightCols<2>().transpose() * contact->friction;
}

double BodyPair::made(const Bodies& bodies) const {
  const Vec3 v = frame.transpose() * (bodies.velocity(end_a) - bodies.velocity(end_b));
  const double before = std::max(0.0, depth), after = std::max(0.0, depth - bodies.T * v.x());
  return bodies.T * (force * v.x() + friction.dot(v.tail<2>())) +
         0.5 * K * (after * after - before * before) +
         0.5 * (friction.squaredNorm() / K - K * anchor.squaredNorm());
}

void BodyPair::finish(Bodies& bodies) {
  BodyContact& c = *contact;
  c.force = force;
  c.friction = frame.rightCols<2>() * friction;
  c.anchor = -c.friction / K;
  c.slipping = force > 0 && radius > 0 && friction.norm() >= radius * force * (1 - 1e-9);
  const double D = -bodies.T * frame.col(0).dot(bodies.velocity(end_a) - bodies.velocity(end_b));
  const double before = std::max(0.0, depth), after = std::max(0.0, depth + D);
  c.pressed = after;
  const double lost = force * D - 0.5 * K * (after * after - before * before);
  c.lost = std::max(0.0, c.lost + lost);
  c.impact.finish(force, mass(bodies), K, bodies.T);
  if (force > 0 && !c.impact.going()) {
    bodies.press(a);
    bodies.press(b);
  }
}

double BodyPair::mass(const Bodies& bodies) const {
  return std::min(kHeaviest, BodyMotion::kTheta * bodies.T / W(0, 0));
}

bool BodyPair::turns(const Bodies& bodies) {
  BodyContact& c = *contact;
  if (!c.impact.may_turn()) return false;
  const BodyEnd middle{bodies.moves(a) ? a : b, Vec3::Zero()};
  now = c.point + bodies.T * bodies.velocity(middle);
  if (apart(bodies) < 0) return false;
  c.impact.turn(restitution);
  parting = restitution * apart(bodies);
  c.lost += 0.5 * K * (1 - restitution * restitution) * c.pressed * c.pressed;
  c.pressed *= restitution;
  c.force *= restitution;
  return true;
}

double BodyPair::part(Bodies& bodies) const {
  const Vec3& n = contact->normal;
  const double more = parting - apart(bodies);
  const double yields = bodies.yields(a, now, n) + bodies.yields(b, now, n);
  if (!(yields > 0)) return 0;
  const Vec3 impulse = more / yields * n;
  bodies.strike(a, now, impulse);
  bodies.strike(b, now, -impulse);
  return std::abs(more);
}

double BodyPair::apart(const Bodies& bodies) const {
  return contact->normal.dot(bodies.speed_at(a, now) - bodies.speed_at(b, now));
}

double BodyPair::energy(const BodyContact& c, const Bodies& bodies) {
  const double d = std::max(0.0, c.depth - c.rest);
  const Vec3 across = c.anchor - c.normal * c.normal.dot(c.anchor);
  return 0.5 * stiffness(c, bodies) * (d * d + across.squaredNorm());
}

}  // namespace limpid
