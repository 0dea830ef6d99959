#include "core/coupling/predictive.h"

#include "core/touch/proxy.h"

namespace limpid {
namespace {

// A wall damps by no more than this part of m_n/T: above it the prediction amplifies.
constexpr double kMostDamping = 0.34;
constexpr int kMostPasses = 5;  // over the set of joints whose motor is at its limit

template <int N>
Vec<N> clip(const Vec<N>& x, const Vec<N>& limit) {
  return x.cwiseMin(limit).cwiseMax(-limit);
}

// Energy of the coupling's spring, whose torque is at most the motor's.
template <int N>
double spring_energy(double k_vc, const Vec<N>& x, const Vec<N>& limit) {
  double V = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double pull = k_vc * std::abs(x[i]);
    V += pull > limit[i] ? limit[i] * std::abs(x[i]) - limit[i] * limit[i] / (2 * k_vc)
                         : pull * std::abs(x[i]) / 2;
  }
  return V;
}

// A torque that is linear in the motion: constant + on_w w + on_u u.
template <int N>
struct Linear {
  Vec<N> constant;
  Mat<N> on_w, on_u;
  Vec<N> at(const Motion<N>& m) const { return constant + on_w * m.w + on_u * m.u; }
};

}  // namespace

// The joint system of a tick: unknown the mean velocities (w, u) of device and proxy,
//     D0 w               = drive + tau1,               tau1 = tE + tL
//     (2/T M2 + S2) u    = momentum + tau2 + f2,
//     tE = - c (w - u) - s0 + C_EL v_L + (g_f - phi^T) f2 - phi^T f1_hat
//     tL = - b_w w + (I - phi^T)(C_LE v_E + u_N - K_N w)
//     tau2 = c (w - u) + s0 - C_EL v_L + phi^T (C_LE v_E + u_N - K_N w) + phi^T f1_hat
//            + (phi^T - g_f) f2,
// with c = b_vc + k_vc T/2, s0 = k_vc (x1 - x2), v_E = w - u, v_L = w - phi v_E.
template <int N>
struct PredictiveLaw::Of<N>::Solve {
  Linear<N> tE, tL, tau2;
  Mat<N> D0, impedance, tE_f2, tau2_f2;
  Vec<N> drive, momentum, limit, tL_last;
  double authority, b_v;
  Vec<N> marks;  // -1, 0, 1: the joint's motor is at its limit

  Solve(const Decomposition<N>& d, const InertiaNetwork<N>& network, const Vec<N>& b_w,
        const Vec<N>& s0, const Vec<N>& f1_hat, double c, double g_f) {
    const Eigen::Index n = s0.size();
    const Mat<N> I = Mat<N>::Identity(n, n);
    const Mat<N> phi = d.phi(), phi_T = phi.transpose();
    const Mat<N> C_LE = d.C_LE(phi);
    const Mat<N> locked_u = -C_LE.transpose() * phi;
    const Mat<N> locked_w = -C_LE.transpose() - locked_u;
    const Mat<N> shaped = network.damps() ? Mat<N>(C_LE - network.damping()) : C_LE;
    const Vec<N> phi_f1 = phi_T * f1_hat;
    const Vec<N> phi_u = phi_T * network.force();
    const Mat<N> phi_shaped = phi_T * shaped;
    const Mat<N> phi_C = phi_T * C_LE;
    tE = {-s0 - phi_f1, locked_w - c * I, locked_u + c * I};
    tL = {network.force() - phi_u, shaped - phi_shaped, phi_C - C_LE};
    tL.on_w.diagonal() -= b_w;
    tau2 = {s0 + phi_u + phi_f1, c * I - locked_w + phi_shaped, -c * I - locked_u - phi_C};
    tE_f2 = g_f * I - phi_T;
    tau2_f2 = phi_T + (1 - g_f) * I;
    marks = tL_last = Vec<N>::Zero(n);
  }

  // A joint at its limit pulls the proxy with that limit, whatever happens; the proxy's damper
  // holds it.
  ContactAnswer<N> system(Motion<N>& right) const {
    Mat<N> ww = D0 - authority * (tE.on_w + tL.on_w);
    Mat<N> wu = -authority * (tE.on_u + tL.on_u);
    Mat<N> uw = -tau2.on_w;
    Mat<N> uu = impedance - tau2.on_u;
    ContactAnswer<N> answer;
    answer.on_device = authority * tE_f2;
    answer.on_proxy = tau2_f2;
    right = {drive + authority * (tE.constant + tL.constant), momentum + tau2.constant};
    for (Eigen::Index i = 0; i < marks.size(); ++i) {
      if (marks[i] == 0) continue;
      const double held = marks[i] * limit[i];
      ww.row(i) = D0.row(i);
      wu.row(i).setZero();
      uw.row(i).setZero();
      uu.row(i) = impedance.row(i);
      uu(i, i) += b_v;
      answer.on_device.row(i).setZero();
      answer.on_proxy.row(i).setZero();
      answer.on_proxy(i, i) = 1;
      right.w[i] = drive[i] + authority * std::clamp(held + tL_last[i], -limit[i], limit[i]);
      right.u[i] = momentum[i] - held;
    }
    answer.system = CoupledSystem<N>(ww, wu, uw, uu);
    return answer;
  }

  // The motors' torque for this motion; true if the marks are those it asks for.
  bool torque(const Motion<N>& m, const Vec<N>& f2, Vec<N>& tau1) {
    const Vec<N> wanted = tE.at(m) + tE_f2 * f2;
    tL_last = tL.at(m);
    bool stay = true;
    Vec<N> given = clip<N>(wanted, limit);
    for (Eigen::Index i = 0; i < marks.size(); ++i) {
      const double over = wanted[i] > limit[i] ? 1 : wanted[i] < -limit[i] ? -1 : 0;
      if (marks[i] != 0) given[i] = marks[i] * limit[i];
      stay = stay && over == marks[i];
      marks[i] = over;
    }
    tau1 = clip<N>(given + tL_last, limit);
    return stay;
  }
};

template <int N>
void PredictiveLaw::Of<N>::start(const LawStart<N>& at) {
  const Vec<N> zero = Vec<N>::Zero(at.x1.size());
  predictor_.start(at.x1, at.v1, at.f1_hat);
  network_.start(at.x1.size());
  y_ = at.x1;
  acted_ = slip_ = tau1_ = zero;
  elapsed_ = 0;
  b_d_ = zero;
  quick_ = false;
}

template <int N>
Whereabouts<N> PredictiveLaw::Of<N>::locate(const Settings& p, const LawReading<N>& in) {
  elapsed_ = in.elapsed;
  both_ = p.hand_mass > 0;
  if (elapsed_ > 0) {
    slip_ = in.x1 - y_ - elapsed_ * predictor_.w();
    predictor_.correct(in.x1, elapsed_, in.encoder_step, p.gains(in.encoder_step, quick_).p, both_);
  } else {  // the first reading, maybe not quite where the device is
    predictor_.begin_at(in.x1);
    ledger_.start(in.x1);
  }
  y_ = in.x1;
  return {predictor_.x_now(), predictor_.v_now()};
}

// The books of the tick just ended, and with them what may be given in the one that begins.
template <int N>
void PredictiveLaw::Of<N>::balance(const Settings& p, const SpringDamper& c, const LawInput<N>& in,
                                   const Proxy<N>& proxy) {
  if (elapsed_ > 0) {
    ledger_.add(y_, acted_, in.b_d_sure, in.encoder_step, elapsed_);
    network_.advance(ledger_.dy(), elapsed_);
  }
  const Vec<N> apart = y_ - proxy.x();
  ledger_.settle(p.energy, spring_energy<N>(c.k_vc, apart, in.limit) + network_.storage() +
                               proxy.kinetic_energy() + proxy.contact_potential());
  ledger_.govern(proxy.f(), slip_, elapsed_ > 0 ? elapsed_ : in.tick);
}

template <int N>
Vec<N> PredictiveLaw::Of<N>::step(double eta, const Settings& p, const SpringDamper& c,
                                  const LawInput<N>& in, Proxy<N>& proxy) {
  const double T = in.tick;
  if (in.b_d != b_d_) {
    quick_ = dies_within_a_tick<N>(in.device.M, in.b_d, T);
    b_d_ = in.b_d;
  }
  const PredictorGains gains = p.gains(in.encoder_step, quick_);
  Jacobian<N> J;
  const Arm<N>& arm = proxy.arm();
  arm.point_jacobian(in.frames, arm.dof() - 1, arm.tip(in.frames), J);
  predictor_.model(in.device.M, in.device.C, in.b_d, J, T, gains, p.hand_mass, p.delay);
  proxy.look(T);
  balance(p, c, in, proxy);

  const Decomposition<N> d(in.device, {proxy.M(), proxy.C(), proxy.v()});
  network_.set(eta, d.M_L, ledger_.damping(), T, p.band);
  Vec<N> b_w = Vec<N>::Constant(in.b_d.size(), c.b_v);
  if (!proxy.contacts().engaged()) {
    b_w -= ledger_.damping() * (1 - p.damping_share(eta)) * (in.b_d + b_w);
  }
  Solve solve(d, network_, b_w, c.k_vc * (predictor_.x() - proxy.x()), in.f1_hat,
              c.b_vc + c.k_vc * T / 2, ledger_.contact());
  solve.D0 = predictor_.D0();
  solve.drive = predictor_.drive();
  solve.impedance = proxy.impedance(T);
  solve.momentum = proxy.momentum(T);
  solve.limit = in.limit;
  solve.authority = in.authority;
  solve.b_v = c.b_v;

  Motion<N> motion;
  Vec<N> f2;
  bool collected = false, settled = false;
  for (int pass = 0; !settled && pass < kMostPasses; ++pass) {
    Motion<N> right;
    ContactAnswer<N> answer = solve.system(right);
    motion = answer.system.solve(right);
    if (!collected) contacts_.collect(proxy.contacts(), arm, proxy.frames(), motion.u, T);
    collected = true;
    if (contacts_.any()) {
      answer.inertia = Factor<N>(in.device.M);
      answer.damping = gains.damping;
      answer.most_damping = kMostDamping;
      contacts_.solve(answer, T, motion);
    }
    f2 = contacts_.f2(in.b_d.size());
    settled = solve.torque(motion, f2, tau1_);
  }
  contacts_.finish(proxy.contacts());
  proxy.step(T, motion.u, f2);
  return tau1_;
}

template <int N>
void PredictiveLaw::Of<N>::applied(const Vec<N>& tau) {
  acted_ = predictor_.acting(tau);
  predictor_.applied(tau, both_);
}

template <int N>
LawReport PredictiveLaw::Of<N>::report() const {
  return {ledger_.reserve(), ledger_.contact(), ledger_.damping()};
}

template class PredictiveLaw::Of<3>;
template class PredictiveLaw::Of<7>;
template class PredictiveLaw::Of<kAnyDof>;

}  // namespace limpid
