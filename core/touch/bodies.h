// The bodies of a scene as the constraints on them see them within a tick.
#pragma once

#include <cstdint>
#include <vector>

#include "core/touch/body_geometry.h"
#include "core/touch/body_motion.h"

namespace limpid {

// A place on a body, as an end of a force; fixed if the body is asleep or none.
struct BodyEnd {
  int body = BodyContact::kStill;
  BodyMotion::Lever lever = Vec3::Zero();
};

struct Bodies {
  explicit Bodies(const Scene& scene);

  std::vector<BodyMotion> motions;
  std::vector<Body> about;
  std::vector<Material> objects;  // by object of the scene
  std::vector<std::uint8_t> awake;
  // Ticks for which a body still counts as pressed by the arm, a contact, a stop or friction.
  std::vector<int> pressed;
  double T = 1e-3;  // length of the tick [s]

  static constexpr int kPressed = 20;

  static std::size_t at(int body) { return static_cast<std::size_t>(body); }
  BodyMotion& operator[](int body) { return motions[at(body)]; }
  const BodyMotion& operator[](int body) const { return motions[at(body)]; }
  int count() const { return static_cast<int>(motions.size()); }
  bool moves(int body) const { return body != BodyContact::kStill && awake[at(body)] != 0; }

  // `rolls`: the round part that rolls there.
  BodyEnd end_at(int body, const Vec3& point, const RoundPart* rolls = nullptr) const {
    if (!moves(body)) return {};
    const BodyMotion& motion = (*this)[body];
    if (rolls == nullptr) return {body, motion.lever(point, T)};
    return {body,
            motion.rolling(point, place(body, rolls->center), directed(body, rolls->axis), T)};
  }
  // An end at the place where a contact is in the middle of the tick.
  BodyEnd end_in_the_middle(int body, const Vec3& point) const {
    if (!moves(body)) return {};
    return {body, point - (*this)[body].turns_at(0.5 * T)};
  }
  Vec3 velocity(const BodyEnd& end) const {  // mean over the tick [m/s]
    if (end.body == BodyContact::kStill) return Vec3::Zero();
    return (*this)[end.body].velocity(end.lever);
  }
  Mat3 answer(const BodyEnd& end) const {  // response to a force there [m/(N s)]
    if (end.body == BodyContact::kStill) return Mat3::Zero();
    return (*this)[end.body].answer(end.lever);
  }
  void push(const BodyEnd& end, const Vec3& force) {
    if (end.body == BodyContact::kStill) return;
    (*this)[end.body].push(end.lever, force);
  }
  // Pushes a with the force and b against it [N].
  void apply(const BodyEnd& a, const BodyEnd& b, const Vec3& force) {
    if (force.isZero(0)) return;
    push(a, force);
    push(b, -force);
  }
  void twist(int body, const Vec3& torque) {  // [N m]
    if (moves(body)) (*this)[body].twist(torque);
  }
  void press(int body) {
    if (moves(body)) pressed[at(body)] = kPressed;
  }

  // Between ticks, as BodyMotion has them.
  Vec3 speed_at(int body, const Vec3& point) const {
    return moves(body) ? (*this)[body].speed_at(point) : Vec3(Vec3::Zero());
  }
  double yields(int body, const Vec3& point, const Vec3& n) const {
    return moves(body) ? (*this)[body].yields(point, n) : 0;
  }
  void strike(int body, const Vec3& point, const Vec3& impulse) {
    if (moves(body)) (*this)[body].strike(point, impulse);
  }

  // Turn a point or a direction from a body's frame to the world's.
  Vec3 place(int body, const Vec3& own) const {
    return body == BodyContact::kStill ? own : Vec3((*this)[body].pose() * own);
  }
  Vec3 directed(int body, const Vec3& own) const {
    return body == BodyContact::kStill ? own : Vec3((*this)[body].pose().linear() * own);
  }
  Vec3 spin(int body) const {  // [rad/s]
    return moves(body) ? (*this)[body].spin() : Vec3(Vec3::Zero());
  }
};

}  // namespace limpid
