#include "render/same_picture.h"

#include <algorithm>

#include "render/marks.h"

namespace limpid {
namespace {

constexpr double kSpan = 0.3;    // of a link: how far a turn moves its end [m]
constexpr double kFlash = 0.25;  // a contact's first moment [s]

// One comparison after the other; a number that is none is never near.
struct Near {
  double tolerance;

  bool operator()(const Vec3& a, const Vec3& b) const { return (a - b).norm() <= tolerance; }
  bool forces(const Vec3& a, const Vec3& b) const {
    return kMetersPerNewton * (a - b).norm() <= tolerance;
  }
  bool operator()(const Pose& a, const Pose& b) const {
    return (*this)(Vec3(a.translation()), Vec3(b.translation())) &&
           kSpan * (a.linear() - b.linear()).norm() <= tolerance;
  }
  bool operator()(const ContactMark& a, const ContactMark& b) const {
    return (*this)(a.position, b.position) && forces(a.force, b.force) &&
           (a.age == b.age || std::min(a.age, b.age) > kFlash) &&
           kSpan * (a.normal - b.normal).norm() <= tolerance && a.friction == b.friction &&
           a.slips == b.slips;
  }
  bool operator()(const ContactShade& a, const ContactShade& b) const {
    return (*this)(a.position, b.position) && std::abs(a.height - b.height) <= tolerance;
  }
  bool operator()(const SecondRun& a, const SecondRun& b) const {
    return (*this)(a.device, b.device) && (*this)(a.proxy, b.proxy) &&
           forces(a.hand_force, b.hand_force) && (*this)(a.contacts, b.contacts);
  }
  template <class T>
  bool operator()(const std::vector<T>& a, const std::vector<T>& b) const {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), *this);
  }
  template <class T>
  bool operator()(const std::optional<T>& a, const std::optional<T>& b) const {
    return a.has_value() == b.has_value() && (!a || (*this)(*a, *b));
  }
  // Trails have a point a frame: those of a tip at rest are the same with any number of them.
  bool trails(const ArmPose& a, const ArmPose& b) const {
    return (*this)(a.trail, b.trail) || (rests(a) && rests(b));
  }
  bool rests(const ArmPose& arm) const {
    return std::ranges::all_of(arm.trail, [&](const Vec3& p) { return (*this)(p, arm.tip); });
  }
  bool operator()(const ArmPose& a, const ArmPose& b) const {
    return (*this)(a.tip, b.tip) && (*this)(a.links, b.links) && trails(a, b);
  }
};

}  // namespace

bool same_picture(const ViewState& a, const ViewState& b, double tolerance) {
  const Near near{tolerance};
  const auto switches = [](const ViewState& s) {
    return std::tuple(s.show_hand, s.hand_grips, s.show_ghost, s.show_error, s.show_trail,
                      s.show_forces, s.show_grid, s.show_joints, s.theme);
  };
  const bool hands = !(a.show_hand && b.show_hand) || near(a.hand_target, b.hand_target);
  return switches(a) == switches(b) && near(a.device, b.device) && near(a.proxy, b.proxy) &&
         near(a.rerun, b.rerun) && near(a.twin, b.twin) && hands &&
         near.forces(a.hand_force, b.hand_force) && near(a.contacts, b.contacts) &&
         near(a.shade, b.shade);
}

}  // namespace limpid
