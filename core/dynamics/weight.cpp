#include "core/dynamics/arm.h"

namespace limpid {

// All beyond a joint weighs on it as one body.
template <int N>
Vec<N> Arm<N>::weight(const Frames& f, const Vec3& gravity) const {
  Vec<N> torque = Vec<N>::Zero(dof());
  double m = 0;
  Vec3 mc = Vec3::Zero();
  for (std::size_t j = size(); j-- > 0;) {
    const LinkModel& link = links_[j];
    const double mass = link.mass[0];
    m += mass;
    mc += mass * (f.p[j] + f.R[j] * link.com.template cast<double>());
    torque[static_cast<Eigen::Index>(j)] =
        -(f.a[j].dot(mc.cross(gravity)) + m * f.o[j].dot(gravity));
  }
  return torque;
}

template Vec<3> Arm<3>::weight(const Frames& f, const Vec3& gravity) const;
template Vec<7> Arm<7>::weight(const Frames& f, const Vec3& gravity) const;
template Vec<kAnyDof> Arm<kAnyDof>::weight(const Frames& f, const Vec3& gravity) const;

}  // namespace limpid
