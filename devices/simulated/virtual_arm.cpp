#include "devices/simulated/virtual_arm.h"

#include <algorithm>
#include <cmath>

#include "core/math/subnormals.h"
#include "core/math/triangular.h"
#include "core/tick/tick.h"
#include "devices/simulated/joint_friction.h"

namespace limpid {

namespace {

// Part of the hand's force that the arm's motion since its linearization takes away [N].
template <int M>
[[gnu::always_inline]] inline void hold(const WideSubsteps& s, Four& force) {
  const Eigen::Index p = wide::rows<M>(s.n);
  Four part[4] = {};
  for (Eigen::Index i = 0; i < p; i += 4) {
    const Four along = four(s.u + i).v * s.stiffness + four(s.v + i).v * s.along_rate;
    for (int a = 0; a < 3; ++a) part[a] += four(s.J_T + a * p + i).v * along;
  }
  wide::sums_of(part, force);
}

template <int M>
[[gnu::always_inline]] inline void take(const WideSubsteps& s) {
  for (Eigen::Index i = 0; i < wide::rows<M>(s.n); i += 4) {
    four(s.sum_u + i).v += four(s.u + i).v;
    four(s.u + i).v += (four(s.v + i).v + four(s.dv + i).v * 0.5) * s.h;
    four(s.v + i).v += four(s.dv + i).v;
  }
}

template <int M>
[[gnu::always_inline]] inline void wide_substeps(const WideSubsteps& s) {
  using namespace wide;
  const Eigen::Index p = rows<M>(s.n);
  Vec3 force = s.force;
  for (int k = 0; k < s.count; ++k, force += s.force_step) {
    Four moved;
    hold<M>(s, moved);
    const double x = force.x() - moved[0], y = force.y() - moved[1], z = force.z() - moved[2];
    for (Eigen::Index i = 0; i < p; i += 4) {
      const double* const J = s.J_T + i;
      four(s.dv + i).v = (four(s.steady + i).v - four(s.damping + i).v * four(s.v + i).v) +
                         (four(J).v * x + four(J + p).v * y + four(J + 2 * p).v * z);
    }
    columns_by_fours(columns<M>(s.n), SolveLower<M>{s.n, s.lower, s.corners, s.dv});
    columns_by_fours_back(columns<M>(s.n), SolveTransposed<M>{s.n, s.lower, s.corners, s.dv});
    take<M>(s);
  }
}

// Takes the same substeps as dv = r - E v + K f, A^-1 multiplied in beforehand. With few joints
// that costs as much as the solves of five substeps, and each substep then waits for less.
template <int M>
[[gnu::always_inline]] inline void prepared_substeps(const WideSubsteps& s) {
  using namespace wide;
  constexpr Eigen::Index p = rows<M>(M);
  double E[M * p] = {}, K[3 * p] = {}, r[p] = {};
  for (Eigen::Index c = 0; c < M; ++c) E[c * p + c] = 1;
  const double* const over = s.corners - p;
  columns_by_fours(M, Divide<M, true>{M, straight<M>(s.lower, M), over, E});
  columns_by_fours_back(M, Divide<M, false>{M, turned<M>(s.lower, M), over, E});
  for (Eigen::Index i = 0; i < p; i += 4) {
    for (Eigen::Index c = 0; c < M; ++c) {
      four(r + i).v += four(E + c * p + i).v * s.steady[c];
      for (int a = 0; a < 3; ++a) four(K + a * p + i).v += four(E + c * p + i).v * s.J_T[a * p + c];
      four(E + c * p + i).v *= s.damping[c];
    }
  }
  Vec3 force = s.force;
  for (int k = 0; k < s.count; ++k, force += s.force_step) {
    Four moved;
    hold<M>(s, moved);
    const double x = force.x() - moved[0], y = force.y() - moved[1], z = force.z() - moved[2];
    for (Eigen::Index i = 0; i < p; i += 4) {
      Four damped = four(E + i).v * s.v[0];
      for (Eigen::Index c = 1; c < M; ++c) damped += four(E + c * p + i).v * s.v[c];
      four(s.dv + i).v = (four(r + i).v - damped) +
                         (four(K + i).v * x + four(K + p + i).v * y + four(K + 2 * p + i).v * z);
    }
    take<M>(s);
  }
}

template <int M>
[[gnu::always_inline]] inline void stiffen_wide(Eigen::Index n, double by, double answer,
                                                const double* J_T, double* A) {
  const Eigen::Index p = wide::rows<M>(n);
  for (Eigen::Index c = 0; c < wide::columns<M>(n); ++c, A += p) {
    const double x = answer * J_T[c], y = answer * J_T[p + c], z = answer * J_T[2 * p + c];
    for (Eigen::Index i = 0; i < p; i += 4) {
      const double* const J = J_T + i;
      four(A + i).v =
          four(A + i).v * by + (four(J).v * x + four(J + p).v * y + four(J + 2 * p).v * z);
    }
  }
}

constexpr int kShare = 5;            // substeps that share a linearization
constexpr double kFar = 0.05;        // linearizations farther apart are not extrapolated [rad]
constexpr double kStopDepth = 0.01;  // a stop yields by this at the motor's limit [rad]

template <int N>
SubstepState<N, Pair> side_by_side(const std::array<SubstepState<N, double>, 2>& states) {
  const auto& [one, two] = states;
  return {paired<N>(one.u, two.u), paired<N>(one.v, two.v), paired<N>(one.sum_u, two.sum_u)};
}

}  // namespace

template <>
LIMPID_WIDE void stiffen<kAnyDof>(Eigen::Index n, double by, double answer, const double* J_T,
                                  double* A) {
  stiffen_wide<kByFours>(n, by, answer, J_T, A);
}

template <>
LIMPID_WIDE void stiffen<7>(Eigen::Index n, double by, double answer, const double* J_T,
                            double* A) {
  stiffen_wide<7>(n, by, answer, J_T, A);
}

template <>
LIMPID_WIDE void run_substeps<kAnyDof>(const WideSubsteps& steps) {
  wide_substeps<kByFours>(steps);
}

template <>
LIMPID_WIDE void run_substeps<7>(const WideSubsteps& steps) {
  if (steps.count > 2) {
    prepared_substeps<7>(steps);
  } else {
    wide_substeps<7>(steps);
  }
}

template <int N>
VirtualArm<N>::VirtualArm(const ArmDescription& arm)
    : arm_(arm),
      damping_(of_joints<N>(arm, &Joint::damping)),
      friction_(of_joints<N>(arm, &Joint::friction)),
      effort_(of_joints<N>(arm, &Joint::effort)),
      lower_(of_joints<N>(arm, &Joint::lower)),
      upper_(of_joints<N>(arm, &Joint::upper)),
      spring_(of_joints<N>(arm, &Joint::spring)),
      offset_(of_joints<N>(arm, &Joint::offset)),
      left_out_(Vec<N>::Zero(arm.dof())),
      gravity_(arm.gravity) {
  const int n = arm.dof();
  place(Vec<N>::Zero(n), Vec<N>::Zero(n), Vec3::Zero());
}

template <int N>
void VirtualArm<N>::place(const Vec<N>& x, const Vec<N>& v, const Vec3& target) {
  x_ = x;
  v_ = v;
  target_ = target;
  hand_torque_ = Vec<N>::Zero(x.size());
  renewed_ = 0;
  linear_.x = x.template cast<Pair>();
  linear_.v = v.template cast<Pair>();
  const auto angles = arm_.angles(x);
  linear_.angles = {angles.sin.template cast<Pair>(), angles.cos.template cast<Pair>()};
  linearize(true, std::nullopt);
}

template <int N>
Drive<N> VirtualArm<N>::drive(const Parameters& p, const Vec<N>& torque,
                              const HandInput& hand) const {
  Drive<N> d{p.tick / p.substeps,
             hand.grip * p.hand_stiffness,
             hand.grip * p.hand_damping,
             hand.grip * p.hand_mass_at_tip,
             target_,
             (hand.target - target_) / p.tick,
             torque,
             resolve<N>(p.damping, damping_),
             resolve<N>(p.friction, friction_),
             false,
             p.springy,
             p.weighs ? std::optional(gravity_of(p.down, gravity_)) : std::nullopt};
  d.friction.array() += p.unknown_friction;
  d.rubs = d.friction.maxCoeff() > 0;
  if (!hand.torque.empty()) d.torque += Eigen::Map<const Vec<N>>(hand.torque.data(), torque.size());
  return d;
}

// Computes the arm's model at both places of linear_.
template <int N>
void VirtualArm<N>::linearize(bool drift, const std::optional<Vec3>& gravity) {
  const int last = arm_.dof() - 1;
  typename Arm<N>::template FramesOf<Pair> frames;
  typename Arm<N>::template Bodies<Pair> bodies;
  arm_.frames(linear_.angles, frames);
  arm_.inertia(frames, bodies, linear_.M);
  for (Eigen::Index i = 0; i <= last; ++i) linear_.M(i, i) -= Pair(left_out_[i]);
  arm_.bias(frames, bodies, linear_.v, linear_.Cv);
  linear_.tip = arm_.tip(frames);
  arm_.point_jacobian(frames, last, linear_.tip, linear_.J);
  linear_.drift = Vec3Of<Pair>::Zero();
  if (drift) linear_.drift = arm_.point_drift(frames, last, linear_.tip, linear_.v);
  if (gravity) {
    typename Arm<N>::Frames own[2];
    for (int i = 0; i < 2; ++i) arm_.take(frames, i, own[i]);
    linear_.Cv += paired<N>(arm_.weight(own[0], *gravity), arm_.weight(own[1], *gravity));
  }
}

template <int N>
bool VirtualArm<N>::within_stops(const Vec<N>& x) const {
  bool within = true;
  for (Eigen::Index i = 0; i < x.size(); ++i) within &= x[i] >= lower_[i] && x[i] <= upper_[i];
  return within;
}

// Takes a substep, with what friction, springs and stops add to A and b around its middle.
template <int N>
template <class Under>
void VirtualArm<N>::resisted_substep(const Drive<N>& d, const Under& model, double t,
                                     SubstepState<N, double>& at) const {
  Mat<N> A = model.A();
  const double h = model.h();
  Vec<N> b = model.b(t + h / 2, at.u, at.v);
  for (Eigen::Index i = 0; i < b.size(); ++i) {
    const double middle = model.x()[i] + at.u[i] + h / 2 * at.v[i];
    const double beyond = std::max(middle - upper_[i], 0.0) + std::min(middle - lower_[i], 0.0);
    double damping = 0, stiffness = 0;
    if (d.springy) {
      b[i] -= spring_[i] * middle + offset_[i];
      A(i, i) += h / 4 * spring_[i];
    }
    if (beyond != 0) {
      stiffness = effort_[i] / kStopDepth;
      damping = std::sqrt(stiffness * model.M(i));
    }
    b[i] -= stiffness * beyond + damping * at.v[i];
    A(i, i) += damping / 2 + h / 4 * stiffness;
  }
  at.take(h, d.rubs ? JointFriction<N>(A, b, at.v, d.friction).change() : solve_symmetric<N>(A, b));
}

// Returns the state after so many substeps from time t, one by one if something resists. `within`:
// whether the arm is within its stops, before and after them.
template <int N>
template <class Under>
[[gnu::always_inline]] inline SubstepState<N, double> VirtualArm<N>::state_after(
    const Drive<N>& d, const Under& model, const SubstepState<N, double>& from, double t,
    int substeps, bool& within) const {
  if (within && !d.rubs && !d.springy) {
    SubstepState<N, double> to = model.state_after(from, t, substeps);
    within = within_stops(model.x() + to.u);
    if (within) return to;
  }
  SubstepState<N, double> at = from;
  for (int s = 0; s < substeps; ++s) resisted_substep(d, model, t + s * model.h(), at);
  within = within_stops(model.x() + at.u);
  return at;
}

// Linearizes at the arm's expected means over `share` substeps from s on, and over as many after
// them. Predicts them in two big steps, with the last two linearizations extrapolated.
template <int N>
void VirtualArm<N>::linearize_ahead(const Drive<N>& d, int s, int share, bool within) {
  // 1.5 shares lie between the middle of the last share and that of the next two together.
  bool near = true;
  for (const Pair& x : linear_.x) near &= std::abs(x[1] - x[0]) < kFar;
  const Linearization<N, double> last = beyond(linear_, near ? 1.5 : 0);
  const double h = share * d.h;
  const LinearSubsteps<N> model(d, h, last);
  SubstepState<N, double> at{x_ - last.x, v_, Vec<N>::Zero(x_.size())};
  std::array<Vec<N>, 2> u, v;  // means
  for (std::size_t i = 0; i < 2; ++i) {
    const SubstepState<N, double> from = at;
    at = state_after(d, model, from, s * d.h + static_cast<double>(i) * h, 1, within);
    const Vec<N> dv = at.v - from.v;
    u[i] = from.u + h / 2 * (from.v + 1. / 3 * dv);
    v[i] = from.v + 0.5 * dv;
  }
  const VecOf<N, Pair> dx = paired<N>(u[0], u[1]);
  linear_.v = paired<N>(v[0], v[1]);
  linear_.x = last.x.template cast<Pair>() + dx;
  linear_.angles = arm_.turned(last.angles, dx);
  linearize(d.mass > 0, d.gravity);
}

template <int N>
void VirtualArm<N>::live(const Parameters& p, const Vec<N>& torque, const HandInput& hand) {
  const NoSubnormals fast_at_rest;
  const Drive<N> d = drive(p, torque, hand);
  renewed_ = renewed_ + 1 < x_.size() ? renewed_ + 1 : 0;  // as turned angles drift
  arm_.renew(renewed_, linear_.x[renewed_][1], linear_.angles);
  hand_torque_.setZero();
  bool within = within_stops(x_);
  for (int s = 0; s < p.substeps;) {
    const int share = std::min(kShare, (p.substeps - s + 1) / 2);
    linearize_ahead(d, s, share, within);
    const LinearSubstepsOfTwo<N> models(d, linear_);
    const std::array<int, 2> substeps{share, std::min(share, p.substeps - s - share)};
    std::array<SubstepState<N, double>, 2> from, to;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto& model = models[static_cast<int>(i)];
      from[i] = {x_ - model.x(), v_, Vec<N>::Zero(x_.size())};
      to[i] = state_after(d, model, from[i], (s + static_cast<int>(i) * share) * d.h, substeps[i],
                          within);
      x_ = model.x() + to[i].u;
      v_ = to[i].v;
    }
    const Pair started(s * d.h, (s + share) * d.h), steps(substeps[0], substeps[1]);
    const VecOf<N, Pair> of_hand =
        linear_.J.transpose() *
        hand_force<N, Pair>(d, linear_, started, steps, side_by_side<N>(from), side_by_side<N>(to));
    for (Eigen::Index i = 0; i < x_.size(); ++i) hand_torque_[i] += of_hand[i][0] + of_hand[i][1];
    s += substeps[0] + substeps[1];
  }
  hand_torque_ /= p.substeps;
  if (!hand.torque.empty()) {
    hand_torque_ += Eigen::Map<const Vec<N>>(hand.torque.data(), x_.size());
  }
  target_ = hand.target;
}

template class VirtualArm<3>;
template class VirtualArm<7>;
template class VirtualArm<kAnyDof>;

}  // namespace limpid
