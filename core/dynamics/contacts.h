// Where the arm touches the scene, and how deep.
#pragma once

#include <span>
#include <vector>

#include "core/dynamics/arm.h"
#include "core/dynamics/scene.h"

namespace limpid {

// One possible contact, linear in the configuration around x2: penetration
// d(x2 + dx) = depth + gradient . dx, torque -gradient K d where d > 0.
template <int N>
struct Contact {
  double depth = 0;            // [m], or [rad] in joint space; negative: apart
  Vec<N> gradient;             // of the depth [m/rad] or [-]
  double stiffness = 0;        // [N/m] or [N m/rad]
  Vec3 point = Vec3::Zero();   // on the arm [m]
  Vec3 normal = Vec3::Zero();  // out of the material; zero in joint space
};

// Finds what is near enough to touch within a tick. Storage for every pair of an obstacle and a
// probe is set aside beforehand.
template <int N>
class Contacts {
 public:
  Contacts(const ArmDescription& arm, const Scene& scene);

  // Refills the list at configuration x, frames f.
  void find(const Arm<N>& arm, const typename Arm<N>::Frames& f, const Vec<N>& x);

  std::span<const Contact<N>> list() const { return {contacts_.data(), count_}; }
  std::size_t capacity() const { return contacts_.size(); }
  double potential() const;  // sum of K max(d, 0)^2 / 2 [J]

 private:
  void add(double depth, double stiffness, const Vec3& point, const Vec3& normal, int link,
           const Arm<N>& arm, const typename Arm<N>::Frames& f);

  Scene scene_;
  std::vector<Probe> probes_;  // the tip first
  std::vector<Contact<N>> contacts_;
  std::size_t count_ = 0;
};

extern template class Contacts<3>;
extern template class Contacts<kAnyDof>;

// Signed distance of a point to the surface, negative inside, and the outward normal there.
struct Surface {
  double distance;  // [m]
  Vec3 normal;
};
Surface distance_to(const Plane& plane, const Vec3& point);
Surface distance_to(const Sphere& sphere, const Vec3& point);
Surface distance_to(const Box& box, const Vec3& point);

// The point of the segment from-to nearest to the obstacle.
Vec3 nearest_on_segment(const Plane& plane, const Vec3& from, const Vec3& to);
Vec3 nearest_on_segment(const Sphere& sphere, const Vec3& from, const Vec3& to);
Vec3 nearest_on_segment(const Box& box, const Vec3& from, const Vec3& to);

}  // namespace limpid
