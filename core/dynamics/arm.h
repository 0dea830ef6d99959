// Kinematics and dynamics of a chain of n revolute and prismatic joints.
//
// Everything is expressed in the base frame about its origin O. A joint's motion is the spatial
// axis S_j = (a_j, o_j): a rate of 1 gives the body the angular velocity a_j and its point at O the
// velocity o_j = p_j x a_j. A slide has a_j = 0 and o_j along its axis.
//
// M and C are sums over the links of J_k^T I_k J_k and J_k^T (I_k Jdot_k + B_k J_k), with
//     B = 1/2 [ (v x*) I + (I v) xbar* - I (v x) ],
// the factorisation for which C equals the Christoffel one (Echeandia & Wensing, 2021), hence
// Mdot = C + C^T and Mdot - 2C skew. About O its blocks collapse: B acts on the angular part only,
//     B (a, o) = (1/2 Idot a - 1/2 L x a, -h x a),
// h and L the link's momentum and angular momentum. Adding the links up from the tip (composite
// bodies) makes each entry one dot product.
//
// About its centre of mass a link has the inertia d 1 + g g^T + e e^T, d the smallest principal
// moment: turning it takes two matrix-vector products.
#pragma once

#include <array>

#include "core/dynamics/arm_description.h"
#include "core/math/sizes.h"
#include "core/math/symmetric.h"

namespace limpid {

template <int N>
class Arm {
 public:
  // Poses of the links at a configuration x. S: double, or Pair for two configurations at a time.
  template <class S>
  struct FramesOf {
    std::array<Mat3Of<S>, kCapacity<N>> R;  // link axes in the base frame
    std::array<Vec3Of<S>, kCapacity<N>> p;  // link origins [m]
    std::array<Vec3Of<S>, kCapacity<N>> a;  // joint axes, unit; 0 for slides
    std::array<Vec3Of<S>, kCapacity<N>> o;  // velocity of O for unit rate [m]
  };
  using Frames = FramesOf<double>;

  // A rigid body about O: mass, first moment, inertia.
  template <class S>
  struct Body {
    S m = 0;
    Vec3Of<S> mc = Vec3Of<S>::Zero();
    Symmetric3<S> I;
  };
  // Rigid bodies of the links at a configuration. The first link is left out: its own joint moves
  // it only about or along a fixed axis, so one number describes it.
  template <class S>
  struct Bodies {
    std::array<Body<S>, kCapacity<N>> link;
    std::array<Body<S>, kCapacity<N>> outer;  // link j and all links beyond it as one
    // Momentum of outer[j] while joint j turns at 1.
    std::array<Vec3Of<S>, kCapacity<N>> moment, force;
  };

  // Precondition: 1 to 32 joints, and exactly N unless N is kAnyDof.
  explicit Arm(const ArmDescription& description);

  int dof() const {
    if constexpr (N != kAnyDof) return N;
    return dof_;
  }

  // Sines and cosines of a configuration; for a slide its coordinate instead of the sine. turned()
  // gives those further on by dx, exact to round-off, for small steps without computing sines anew;
  // renew() computes one joint's.
  template <class S>
  struct AnglesOf {
    VecOf<N, S> sin, cos;
  };
  using Angles = AnglesOf<double>;
  Angles angles(const Vec<N>& x) const;
  template <class S>
  void renew(Eigen::Index joint, double x, AnglesOf<S>& angles) const;
  template <class S>
  AnglesOf<S> turned(const Angles& angles, const VecOf<N, S>& dx) const;

  template <class S>
  void frames(const AnglesOf<S>& angles, FramesOf<S>& f) const;
  void frames(const Vec<N>& x, Frames& f) const { frames(angles(x), f); }

  // M(x) [kg m^2].
  void inertia(const Frames& f, Mat<N>& M) const;
  // M(x), and C(x, v) with Mdot - 2C skew [kg m^2/s].
  void inertia_coriolis(const Frames& f, const Vec<N>& v, Mat<N>& M, Mat<N>& C) const;
  // M(x), and the torque C(x, v) v alone: cheaper where the matrix is not needed [N m].
  void inertia_bias(const Frames& f, const Vec<N>& v, Mat<N>& M, Vec<N>& Cv) const;

  // The same in two steps, for callers that learn v only from M.
  template <class S>
  void inertia(const FramesOf<S>& f, Bodies<S>& bodies, MatOf<N, S>& M) const;
  template <class S>
  void coriolis(const FramesOf<S>& f, const Bodies<S>& bodies, const VecOf<N, S>& v,
                MatOf<N, S>& C) const;
  template <class S>
  void bias(const FramesOf<S>& f, const Bodies<S>& bodies, const VecOf<N, S>& v,
            VecOf<N, S>& Cv) const;

  // Copies configuration `which` of a pair.
  void take(const FramesOf<Pair>& both, int which, Frames& one) const;

  // Torque of the motors that holds the links' weight: the slope of its potential [N m]. gravity:
  // in the base's frame [m/s^2].
  Vec<N> weight(const Frames& f, const Vec3& gravity) const;

  template <class S>
  Vec3Of<S> tip(const FramesOf<S>& f) const {
    return point(f, dof() - 1, tip_);
  }
  Vec3 tip_at(const Vec<N>& x) const {
    Frames f;
    frames(x, f);
    return tip(f);
  }
  template <class S>
  static Vec3Of<S> point(const FramesOf<S>& f, int link, const Vec3& in_link) {
    const auto i = static_cast<std::size_t>(link);
    return f.p[i] + f.R[i] * in_link.cast<S>();
  }
  // Velocity of a point fixed to `link`, now at `world`, for unit joint rates [m]; J is 3 x n.
  template <class S>
  void point_jacobian(const FramesOf<S>& f, int link, const Vec3Of<S>& world,
                      JacobianOf<N, S>& J) const;
  // Acceleration of such a point at constant joint rates, Jdot v [m/s^2].
  template <class S>
  Vec3Of<S> point_drift(const FramesOf<S>& f, int link, const Vec3Of<S>& world,
                        const VecOf<N, S>& v) const;

 private:
  // Model of a joint. It turns two columns of R0 Q and leaves the third, its axis; Q^T then leads
  // to the link's own axes. If the axis is one of those, Q only reorders, and Q and Q^T are left
  // out.
  //
  // Each number is stored as a pair, ready for two configurations at a time.
  struct JointModel {
    Mat3Of<Pair> R0;                       // or R0 Q
    bool shifted = false;                  // R0 is not the identity
    bool oblique = false;                  // the axis is none of x, y, z
    Mat3Of<Pair> back;                     // Q^T where oblique
    int first = 0, second = 1, third = 2;  // columns: first turns towards second, third the axis
    Pair sign = 1;                         // -1 where the axis points against the third column
    bool slides = false;
    Vec3Of<Pair> offset;  // origin in the previous link's frame [m]
  };
  struct LinkModel {
    Pair mass;          // [kg]
    Vec3Of<Pair> com;   // in the link's frame [m]
    Pair d;             // inertia about com: d 1 + g g^T + e e^T [kg m^2]
    Vec3Of<Pair> g, e;  // in the link's axes
  };

  std::size_t size() const { return static_cast<std::size_t>(dof()); }
  static JointModel model(const Joint& joint);
  template <class S>
  static void turn(const JointModel& joint, const S& sin, const S& cos, const Mat3Of<S>& before,
                   Mat3Of<S>& R, Vec3Of<S>& axis);
  template <class S>
  void place_link(const FramesOf<S>& f, std::size_t i, Bodies<S>& bodies) const;

  int dof_;
  std::array<JointModel, kCapacity<N>> joints_;
  std::array<LinkModel, kCapacity<N>> links_;
  double first_inertia_ = 0;  // inertia of the first link along its joint [kg m^2]
  Vec3 tip_;
};

extern template class Arm<3>;
extern template class Arm<7>;
extern template class Arm<kAnyDof>;

// Values of `field`, one for each joint.
template <int N>
Vec<N> of_joints(const ArmDescription& arm, double Joint::*field) {
  Vec<N> values = Vec<N>::Zero(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) values[i] = arm.joints[static_cast<std::size_t>(i)].*field;
  return values;
}

}  // namespace limpid
