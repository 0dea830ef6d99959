// Contacts of the arm with the scene: their places, depths and forces within a tick.
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

// Point of the segment from-to nearest to a shape.
Vec3 nearest_on_segment(const Plane& plane, const Pose& pose, const Vec3& from, const Vec3& to);
Vec3 nearest_on_segment(const Sphere& sphere, const Pose& pose, const Vec3& from, const Vec3& to);
Vec3 nearest_on_segment(const Box& box, const Pose& pose, const Vec3& from, const Vec3& to);
Vec3 nearest_on_segment(const Cylinder& cylinder, const Pose& pose, const Vec3& from,
                        const Vec3& to);
Vec3 nearest_on_segment(const Capsule& capsule, const Pose& pose, const Vec3& from, const Vec3& to);

// A possible contact, linear in the configuration around x2: penetration d(x2 + dx) = depth +
// gradient . dx, torque -gradient K d where d > 0.
template <int N>
struct Contact {
  double depth = 0;                // [m], or [rad] in joint space; negative: apart
  Vec<N> gradient;                 // of the depth [m/rad] or [-]
  Material material;               // in joint space its stiffness is in [N m/rad]
  Vec3 point = Vec3::Zero();       // on the arm [m]
  Vec3 normal = Vec3::Zero();      // out of the material; zero in joint space
  int link = 0;                    // index of the touching link
  std::size_t id = 0;              // constant for a scene
  int body = BodyContact::kStill;  // body with this surface
  bool touching = false;
  double force = 0;              // over the last tick [N] or [N m]
  Vec3 friction = Vec3::Zero();  // along the surface, over the last tick [N]
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

// A ball of the arm against a mesh. The nearest x that the mesh leaves free pulls its centre c(x2 +
// dx) = center + J dx by K (x - c). Within a tick the free places are a room of planes.
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
  Mat3 direction = Mat3::Identity();  // orthonormal columns along which it pushes
  int rank = 0;                       // columns used
  Vec3 depth = Vec3::Zero();          // along each column, at x2 [m]
  Vec3 force = Vec3::Zero();          // over the last tick, with friction [N]
};

// Share of the contacts' torque f2 that acts on the proxy with a law's feedforward:
//     direct f2 + shared M2 M_L^-1 f2.
template <int N>
struct ContactShare {
  double direct = 1, shared = 0;
  const SymmetricFactor<N>* M_L = nullptr;  // if shared is not 0

  Vec<N> of(const Vec<N>& f2, const Mat<N>& M2) const {
    if (shared == 0) return direct * f2;
    return direct * f2 + shared * (M2 * M_L->solve(f2));
  }
};

// Finds the contacts near enough to touch within a tick, and keeps their state. Storage for every
// pair of an obstacle and a probe is allocated beforehand.
template <int N>
class Contacts {
 public:
  // Needs the triangles of every mesh. A capsule meets meshes as a row of balls.
  Contacts(const ArmDescription& arm, const Scene& scene);

  // Forgets all remembered sides, and looks anew at configuration x, frames f.
  void place(const Arm<N>& arm, const typename Arm<N>::Frames& f, const Vec<N>& x);
  // Looks at configuration x, frames f, before a tick of length T [s].
  void find(const Arm<N>& arm, const typename Arm<N>::Frames& f, const Vec<N>& x, double T);
  // Takes over the sides of another scene's contacts, where meshes are the same.
  void take_over(const Contacts& other);
  // True if a start from here would find the same sides.
  bool recoverable() const;

  // Adds the contacts' part in the midpoint step (Proxy), for those assumed to push:
  //     A += share K T/2 G G^T,   b -= share K depth G,   G the gradients.
  void add_to(Mat<N>& A, Vec<N>& b, double T, const ContactShare<N>& share, const Mat<N>& M2) const;
  // Computes the forces at the midpoint of a step with this velocity, and their torque f2. True if
  // the contacts assumed to push are those that do.
  bool push(const Vec<N>& vbar, double T, Vec<N>& f2);
  // Revises the set of contacts assumed to push after such a step; `only_let_go`: only removes.
  // False: nothing changed.
  bool reconsider(const Vec<N>& vbar, double T, bool only_let_go);

  std::span<const Contact<N>> list() const { return {contacts_.data(), count_}; }
  std::size_t capacity() const { return contacts_.size(); }
  std::span<const MeshContact<N>> meshes() const { return meshes_; }
  // Access for laws that solve for the forces themselves.
  std::span<Contact<N>> list() { return {contacts_.data(), count_}; }
  std::span<MeshContact<N>> meshes() { return meshes_; }
  ContactMemory& memory(std::size_t id) { return memories_[id]; }
  // True if some surface of the scene has friction or damping.
  bool rub() const { return rub_; }
  // True if a contact is inside, or pushed over the last tick.
  bool engaged() const;
  void forget() { std::ranges::fill(memories_, ContactMemory{}); }

  // Copies the forces of the last tick, the hardest if not all fit; returns how many. Contacts in
  // joint space have no place and are not among them.
  std::size_t forces(std::span<ContactForce> into) const;
  // Stiffness of the stiffest surface [N/m].
  double stiffest() const { return stiffest_; }
  // The scene's bodies; null: nothing moves.
  BodyWorld* world() { return world_.get(); }
  const BodyWorld* world() const { return world_.get(); }
  // Sets whether the tip, from the next find() on, holds a magnetic body near it, or lets go.
  void want_magnet(bool on) { magnet_wanted_ = on; }
  // The magnet's hold over the tick: a spring from the tip to a point of a body.
  struct Magnet {
    bool on = false;
    int body = BodyContact::kStill;
    Vec3 at = Vec3::Zero();       // the body's point [m]
    Vec3 stretch = Vec3::Zero();  // stretch of the spring: from `at` to the tip [m]
    Material material;
    Jacobian<N> J;              // of the tip
    Vec3 force = Vec3::Zero();  // on the tip, over the last tick [N]
  };
  Magnet& magnet() { return magnet_; }
  const Magnet& magnet() const { return magnet_; }

  // Steps the bodies with the forces that push() found, for laws that do not solve for bodies.
  void step_bodies();

  // Energy of all springs at find(), with friction's [J].
  double potential() const { return potential_; }

 private:
  // An object in the form that a tick needs.
  struct Solid {
    std::variant<Plane, Sphere, Box, Cylinder, Capsule> shape;  // shapes of distance_to()
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
extern template class Contacts<kAnyDof>;

}  // namespace limpid
