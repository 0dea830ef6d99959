// A contact of the arm in the solve of all of them: forces along the axes of a frame. A wall's axes
// are its normal and two tangents; without friction only the first is used. Other frames are the
// world's.
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "core/math/coupled_system.h"
#include "core/touch/body_world.h"
#include "core/touch/wall_force.h"

namespace limpid {

template <int N>
struct Contact;
template <int N>
struct MeshContact;
class SolidCorner;
template <int N, class Touch>
struct RoomContact;
template <int N>
struct MagnetContact;
// A kind of contacts more has its name here, and in Contacts::kinds().
template <int N>
using AnyContact =
    std::variant<Contact<N>*, MeshContact<N>*, RoomContact<N, SolidCorner>*, MagnetContact<N>*>;

// Response of everything that moves to torques, and to a torque f2 of the contacts on the proxy.
// Unknown are the device's motion w and the proxy's relative motion u - w.
template <int N>
struct ContactAnswer {
  ContactAnswer() = default;
  // Builds the system from its blocks.
  template <class... Blocks>
  ContactAnswer(double device, const Wide<N>& proxy, const Blocks&... blocks)
      : system(blocks...), on_device(device), on_proxy(proxy) {}

  CoupledSystem<N> system;
  double on_device = 0;  // share of f2 in the first rows
  Wide<N> on_proxy;      // share of f2 in the second rows [-]
  // Inertia behind a wall's damping; null: walls have only their material's damping.
  const SymmetricFactor<N>* inertia = nullptr;
  double damping = 0;       // see wall_damping() [-]
  double jump = 0;          // jump of a joint's velocity when its encoder makes a step [rad/s]
  double most_damping = 0;  // largest damping of a wall, in m_n/T [-]

  Motion<N> solve(const Motion<N>& b) const {
    Motion<N> m = system.solve(b);
    m.u += m.w;
    return m;
  }
  Motion<N> respond(const Vec<N>& f2) const {
    return solve({on_device * f2, times<N>(on_proxy, f2)});
  }
};

// State of a contact with friction, kept from tick to tick.
struct ContactMemory {
  Vec3 push = Vec3::Zero();    // of a wall: its force along x; of a mesh: a vector [N]
  Vec3 anchor = Vec3::Zero();  // stretch of friction's spring [m]
  bool slipping = false;
};

// Largest stiffness of friction's spring [N/m].
inline constexpr double kStiffestFriction = 2000;
inline double friction_stiffness(const Material& m) {
  return std::min(m.stiffness, kStiffestFriction);
}

inline double friction_radius(const Material& m, bool slipping) {
  return slipping ? m.friction_kinetic : std::max(m.friction_static, m.friction_kinetic);
}

// Frame of a unit vector and two unit vectors across it.
inline Mat3 frame_of(const Vec3& normal) {
  Mat3 frame;
  frame.col(0) = normal;
  frame.col(1) = normal.unitOrthogonal();
  frame.col(2) = normal.cross(frame.col(1));
  return frame;
}

template <int N>
struct ContactRow {
  AnyContact<N> source;
  Material material;
  ContactMemory before;
  int axes = 1;
  bool flat = false;  // the normal is the first axis, wherever the force points
  double radius = 0;  // of friction's disc, by the normal force [-]
  Mat3 frame = Mat3::Identity();
  std::array<Vec<N>, 3> g;       // torque of a unit force along each axis
  std::array<Motion<N>, 3> Z;    // motion by this torque
  Mat3 W = Mat3::Zero();         // g_i . Z_j.u [m/(N s)]
  double B = 0;                  // damping [N s/m]
  bool known = false;            // Z and W are known
  Vec3 push = Vec3::Zero();      // along the axes, without friction [N]
  Vec3 friction = Vec3::Zero();  // [N]
  // State of a body's surface.
  BodyWorld* world = nullptr;
  BodyWorld::End end;
  Mat3 W_body = Mat3::Zero();     // along the axes [m/(N s)]
  Vec3 on_body = Vec3::Zero();    // force applied to it so far, with opposite sign [N]
  Vec3 rubbed = Vec3::Zero();     // friction's part of on_body [N]
  Vec3 body_free = Vec3::Zero();  // its velocity without on_body, along the axes [m/s]

  void clear() {
    axes = 1;
    flat = false;
    radius = B = 0;
    frame.setIdentity();
    W.setZero();
    known = false;
    push.setZero();
    friction.setZero();
    world = nullptr;
    end = {};
    W_body.setZero();
    on_body.setZero();
    rubbed.setZero();
    body_free.setZero();
  }
  // Sets all three axes: those of the world, by a Jacobian.
  void set_axes(const Jacobian<N>& J) {
    axes = 3;
    for (int i = 0; i < 3; ++i) g[static_cast<std::size_t>(i)] = J.row(i).transpose();
  }
  Vec3 of_body() const {  // velocity of the row's body along the row's axes [m/s]
    Vec3 v = Vec3::Zero();
    if (world != nullptr) v = frame.transpose() * world->velocity(end);
    if (axes == 1) v.tail<2>().setZero();
    return v;
  }
  Vec3 speed(const Vec<N>& u) const {
    Vec3 v = Vec3::Zero();
    for (int i = 0; i < axes; ++i) v[i] = g[static_cast<std::size_t>(i)].dot(u);
    return v;
  }
  // Stretch of friction's spring, in the row's axes [m].
  Vec3 anchor() const { return flat ? Vec3(frame.transpose() * before.anchor) : before.anchor; }
  // Frame of a force along `normal`, in the row's axes.
  Mat3 across(const Vec3& normal) const { return flat ? Mat3(Mat3::Identity()) : frame_of(normal); }
  void apply(const Vec3& change, Motion<N>& motion) {
    if (world != nullptr) {
      world->push(end, -(frame * change));
      on_body += change;
    }
    for (int i = 0; i < axes; ++i) {
      if (change[i] != 0) motion.add(change[i], Z[static_cast<std::size_t>(i)]);
    }
  }
  // Updates friction across the normal, in the row's axes; returns the change [N].
  double rub(double T, const Vec3& normal, double force, Motion<N>& motion) {
    if (radius == 0 || axes < 3) return 0;
    const Mat3 own = across(normal);
    const auto tangents = own.template rightCols<2>();
    const Vec3 was = friction;
    const Mat2 W_t = tangents.transpose() * W * tangents;
    const Vec2 b = tangents.transpose() * (speed(motion.u) - of_body() - W * was);
    const Vec2 l = friction_force(friction_stiffness(material), radius * force,
                                  tangents.transpose() * anchor(), T, b, W_t);
    friction = tangents * l;
    const Vec3 change = friction - was;
    apply(change, motion);
    return change.norm();
  }
};

}  // namespace limpid
