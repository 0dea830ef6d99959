// Where the arm touches the scene, how deep, and what comes of it within a tick.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "core/dynamics/arm.h"
#include "core/math/solve.h"
#include "core/touch/body_world.h"
#include "core/touch/mesh_touch.h"
#include "core/touch/scene.h"

namespace limpid {

// Signed distance of a point to the surface, negative inside, and the outward normal there.
struct Surface {
  double distance;  // [m]
  Vec3 normal;
};
Surface distance_to(const Plane& plane, const Pose& pose, const Vec3& point);
Surface distance_to(const Sphere& sphere, const Pose& pose, const Vec3& point);
Surface distance_to(const Box& box, const Pose& pose, const Vec3& point);
Surface distance_to(const Cylinder& cylinder, const Pose& pose, const Vec3& point);
Surface distance_to(const Capsule& capsule, const Pose& pose, const Vec3& point);

// The point of the segment from-to nearest to a shape.
Vec3 nearest_on_segment(const Plane& plane, const Pose& pose, const Vec3& from, const Vec3& to);
Vec3 nearest_on_segment(const Sphere& sphere, const Pose& pose, const Vec3& from, const Vec3& to);
Vec3 nearest_on_segment(const Box& box, const Pose& pose, const Vec3& from, const Vec3& to);
Vec3 nearest_on_segment(const Cylinder& cylinder, const Pose& pose, const Vec3& from,
                        const Vec3& to);
Vec3 nearest_on_segment(const Capsule& capsule, const Pose& pose, const Vec3& from, const Vec3& to);

// One possible contact, linear in the configuration around x2: penetration
// d(x2 + dx) = depth + gradient . dx, torque -gradient K d where d > 0.
template <int N>
struct Contact {
  double depth = 0;                // [m], or [rad] in joint space; negative: apart
  Vec<N> gradient;                 // of the depth [m/rad] or [-]
  Material material;               // in joint space its stiffness is in [N m/rad]
  Vec3 point = Vec3::Zero();       // on the arm [m]
  Vec3 normal = Vec3::Zero();      // out of the material; zero in joint space
  int link = 0;                    // that touches
  std::size_t id = 0;              // the same as long as the scene is
  int body = BodyContact::kStill;  // whose surface it is
  bool touching = false;
  double force = 0;              // over the last tick [N] or [N m]
  Vec3 friction = Vec3::Zero();  // the same, along the surface [N]
};

// State of a contact from tick to tick, where surfaces rub.
struct ContactMemory {
  Vec3 push = Vec3::Zero();    // of the wall: along x the force [N]; of a mesh: as a vector [N]
  Vec3 anchor = Vec3::Zero();  // how far the spring of friction is stretched [m]
  bool slipping = false;
};

// The spring of friction: no stiffer than this [N/m].
inline constexpr double kStiffestFriction = 2000;
inline double friction_stiffness(const Material& m) {
  return std::min(m.stiffness, kStiffestFriction);
}

// A ball of the arm against a mesh: its centre c(x2 + dx) = center + J dx is pulled by K (x - c) to
// the nearest x that the mesh leaves free, within a tick a room of planes.
template <int N>
struct MeshContact {
  MeshContact(const Object& mesh, double radius, Eigen::Index dof)
      : touch(mesh, radius), material(mesh.material), J(Jacobian<N>::Zero(3, dof)) {}

  MeshTouch touch;
  int link = 0;        // index
  std::size_t id = 0;  // among all contacts
  int body = BodyContact::kStill;
  Vec3 on_link = Vec3::Zero();  // the ball's centre, in the link's frame [m]
  Material material;
  Vec3 center = Vec3::Zero();         // [m]
  Jacobian<N> J;                      // of the centre
  FreeSpace::Active active;           // planes that push
  Mat3 direction = Mat3::Identity();  // columns: orthonormal, along which it pushes
  int rank = 0;                       // columns used
  Vec3 depth = Vec3::Zero();          // along each of them at x2 [m]
  Vec3 force = Vec3::Zero();          // over the last tick, with friction [N]
};

// What comes of the contacts' torque f2 on the proxy, with what a law makes of it besides:
//     direct f2 + shared M2 M_L^-1 f2.
template <int N>
struct ContactShare {
  double direct = 1, shared = 0;
  const SymmetricFactor<N>* M_L = nullptr;  // where shared is not 0

  Vec<N> of(const Vec<N>& f2, const Mat<N>& M2) const {
    if (shared == 0) return direct * f2;
    return direct * f2 + shared * (M2 * M_L->solve(f2));
  }
};

// Finds what is near enough to touch within a tick, and keeps account of what does. Storage for
// every pair of an obstacle and a probe is set aside beforehand.
template <int N>
class Contacts {
 public:
  // Every mesh has its shape. A capsule meets meshes as a row of balls.
  Contacts(const ArmDescription& arm, const Scene& scene);

  // Forgets what it remembers of sides, and looks anew at configuration x, frames f.
  void place(const Arm<N>& arm, const typename Arm<N>::Frames& f, const Vec<N>& x);
  // Looks at configuration x, frames f, before a tick of length T [s].
  void find(const Arm<N>& arm, const typename Arm<N>::Frames& f, const Vec<N>& x, double T);
  // Remembers the sides that another scene's contacts are on, as far as meshes are the same.
  void take_over(const Contacts& other);
  // Starting anew here would find the same sides.
  bool recoverable() const;

  // The contacts' part in the midpoint step (Proxy): with those thought to push,
  //     A += share K T/2 G G^T,   b -= share K depth G,   G the gradients.
  void add_to(Mat<N>& A, Vec<N>& b, double T, const ContactShare<N>& share, const Mat<N>& M2) const;
  // The forces at the midpoint of a step with this velocity, their torque f2, and whether those
  // thought to push are those that do.
  bool push(const Vec<N>& vbar, double T, Vec<N>& f2);
  // Thinks again who pushes after such a step; `only_let_go`: nobody new. False: nothing changed.
  bool reconsider(const Vec<N>& vbar, double T, bool only_let_go);

  std::span<const Contact<N>> list() const { return {contacts_.data(), count_}; }
  std::size_t capacity() const { return contacts_.size(); }
  std::span<const MeshContact<N>> meshes() const { return meshes_; }
  // For laws that solve for the forces themselves.
  std::span<Contact<N>> list() { return {contacts_.data(), count_}; }
  std::span<MeshContact<N>> meshes() { return meshes_; }
  ContactMemory& memory(std::size_t id) { return memories_[id]; }
  // Some surface of the scene has friction or damping.
  bool rub() const { return rub_; }
  // Something is in, or pushed over the last tick.
  bool engaged() const;
  void forget() { std::ranges::fill(memories_, ContactMemory{}); }

  // Copies what pushed over the last tick, the hardest if not all fit; returns how many. Contacts
  // in joint space are nowhere and not among them.
  std::size_t forces(std::span<ContactForce> into) const;
  // Of all surfaces [N/m].
  double stiffest() const { return stiffest_; }
  // What moves of the scene; null: nothing.
  BodyWorld* world() { return world_.get(); }
  const BodyWorld* world() const { return world_.get(); }
  // From the next find() on the tip holds what it may and is near to, or lets go of it.
  void want_magnet(bool on) { magnet_wanted_ = on; }
  // That holds something, over the tick: a spring from the tip to a point of a body.
  struct Magnet {
    bool on = false;
    int body = BodyContact::kStill;
    Vec3 at = Vec3::Zero();       // that point [m]
    Vec3 stretch = Vec3::Zero();  // of the spring: from there to the tip [m]
    Material material;
    Jacobian<N> J;              // of the tip
    Vec3 force = Vec3::Zero();  // on the tip, over the last tick [N]
  };
  Magnet& magnet() { return magnet_; }
  const Magnet& magnet() const { return magnet_; }

  // For laws that do not solve for bodies: they get the forces that push() found, and step after.
  void step_bodies();

  // Of all springs as they were found, those of friction too [J].
  double potential() const { return potential_; }

 private:
  // Objects as a tick wants them.
  struct Solid {
    std::variant<Plane, Sphere, Box, Cylinder, Capsule> shape;  // those that distance_to() knows
    Pose pose;
    Material material;
    int body = BodyContact::kStill;
    Pose in_body = Pose::Identity();
  };
  struct Stop {
    JointStop at;
    Material material;
  };

  double stored() const;
  void add(const Contact<N>& found, const Arm<N>& arm, const typename Arm<N>::Frames& f);
  void add_mesh_contacts(const Object& mesh, int body, const ArmDescription& arm);
  void look(MeshContact<N>& contact, const Arm<N>& arm, const typename Arm<N>::Frames& f);
  static void aim(MeshContact<N>& contact);

  void add_solid(const Shape& shape, const Pose& in_object, const Object& object, int body);
  void follow_bodies();
  void look_for_magnet(const Arm<N>& arm, const typename Arm<N>::Frames& f);

  std::vector<Probe> probes_;  // the tip first
  std::vector<Solid> solids_;
  std::vector<Stop> stops_;
  std::vector<Contact<N>> contacts_;
  std::size_t count_ = 0;
  std::vector<MeshContact<N>> meshes_;
  std::vector<ContactMemory> memories_;  // by id
  std::unique_ptr<BodyWorld> world_;
  std::vector<Material> of_bodies_;
  bool magnet_wanted_ = false;
  Magnet magnet_;
  double potential_ = 0;
  double stiffest_ = 0;
  bool rub_ = false;
};

extern template class Contacts<3>;
extern template class Contacts<7>;
extern template class Contacts<kAnyDof>;

}  // namespace limpid
