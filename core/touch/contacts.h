// Contacts of the arm with the scene: their places, depths and forces within a tick.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "core/dynamics/arm.h"
#include "core/math/solve.h"
#include "core/touch/body_world.h"
#include "core/touch/corner_contact.h"
#include "core/touch/magnet_contact.h"
#include "core/touch/mesh_contact.h"
#include "core/touch/scene.h"
#include "core/touch/solid_touch.h"
#include "core/touch/wall_contact.h"

namespace limpid {

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
  std::span<const CornerContact<N>> corners() const { return corners_; }
  // Access for laws that solve for the forces themselves.
  std::span<Contact<N>> list() { return {contacts_.data(), count_}; }
  std::span<MeshContact<N>> meshes() { return meshes_; }
  std::span<CornerContact<N>> corners() { return corners_; }
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
  const MagnetContact<N>& magnet() const { return magnet_; }

  // All kinds of contacts. A new one has a place here and its name in AnyContact. Sums are taken in
  // these orders, so they decide on the last bits of rows.
  // Both have every kind of AnyContact.
  auto kinds() { return std::tuple(list(), meshes(), corners(), std::span(&magnet_, 1)); }
  auto kinds() const { return std::tuple(list(), meshes(), corners(), std::span(&magnet_, 1)); }
  auto magnet_first() { return std::tuple(std::span(&magnet_, 1), list(), meshes(), corners()); }
  auto magnet_first() const {
    return std::tuple(std::span(&magnet_, 1), list(), meshes(), corners());
  }

  // Steps the bodies with the forces that push() found, for laws that do not solve for bodies.
  void step_bodies();

  // Energy of all springs at find(), with friction's [J].
  double potential() const { return potential_; }

 private:
  struct Stop {
    JointStop at;
    Material material;
  };

  double stored() const;
  void add(const Contact<N>& found, const Arm<N>& arm, const typename Arm<N>::Frames& f);
  void add_mesh_contacts(const Object& mesh, int body, const ArmDescription& arm);
  Vec3 lifted_out_of_meshes(Vec3 point, const Vec3& centre, std::size_t probe,
                            const MeshContact<N>* except, bool whole) const;
  void follow(bool holds, double T);
  Vec3 free_place(const MeshContact<N>& of, bool whole) const;
  bool has_company(const MeshContact<N>& mesh) const;
  bool covers_others(const MeshContact<N>& mesh) const;
  void pass_on();
  void look_at_corner(std::size_t probe, const Arm<N>& arm, const typename Arm<N>::Frames& f);
  bool in_corner(std::size_t probe, const SolidTouch::Near& near) const;
  Material material_of(std::size_t id) const;
  bool covered(const MeshContact<N>& mesh, const Vec3& place, const Vec3& free) const;
  void look(MeshContact<N>& contact, const Arm<N>& arm, const typename Arm<N>::Frames& f);

  void add_solid(const Shape& shape, const Pose& in_object, const Object& object, int body);
  void follow_bodies();
  void look_for_magnet(const Arm<N>& arm, const typename Arm<N>::Frames& f);

  std::vector<Probe> probes_;  // the tip first
  std::vector<Solid> solids_;
  std::vector<SolidTouch> touches_;  // of each probe
  std::vector<Stop> stops_;
  std::vector<Contact<N>> contacts_;
  std::size_t count_ = 0;
  std::vector<MeshContact<N>> meshes_;
  std::vector<CornerContact<N>> corners_;            // of each probe, if solids can meet; for balls
  std::vector<std::vector<MeshContact<N>*>> balls_;  // the contacts with meshes of each probe
  std::vector<ContactMemory> memories_;              // by id
  std::unique_ptr<BodyWorld> world_;
  std::vector<Material> of_bodies_;
  bool magnet_wanted_ = false;
  MagnetContact<N> magnet_;
  double potential_ = 0;
  double stiffest_ = 0;
  bool rub_ = false;
};

extern template class Contacts<3>;
extern template class Contacts<7>;
extern template class Contacts<kAnyDof>;

}  // namespace limpid
