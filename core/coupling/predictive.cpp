#include "core/coupling/predictive.h"

#include <limits>

#include "core/coupling/decomposition.h"
#include "core/coupling/inertia_network.h"
#include "core/coupling/laws.h"
#include "core/coupling/ledger.h"
#include "core/coupling/limited_solve.h"
#include "core/coupling/predictor.h"
#include "core/coupling/spring_coupling.h"
#include "core/dynamics/torque_limits.h"
#include "core/touch/proxy.h"

namespace limpid {
namespace {

// Largest damping of a wall, as a part of m_n/T: above it the prediction amplifies.
constexpr double kMostDamping = 0.34;
// Part of the limit: while a spring pulls with more than this, ticks with motors at their limit go
// on.
constexpr double kStillPulled = 0.02;
constexpr int kMostTurns = 16;       // turns between bodies and the rest
constexpr double kSameForce = 1e-5;  // change of force at which the turns end [N]
// Unforeseen push of a hand in a tick, and the most that it changes of the device's velocity.
constexpr double kPushed = 4e-4, kSurprise = 0.5;  // [N s], [rad/s]

template <int N>
Vec<N> clip(const Vec<N>& x, const Vec<N>& limit) {
  return x.cwiseMin(limit).cwiseMax(-limit);
}

// Energy of a spring whose torque is the motor's limit everywhere.
template <int N>
double limit_energy(const Vec<N>& x, const Vec<N>& limit) {
  return limit.dot(x.cwiseAbs());
}

// Tells the predictor what the hand may do. on_tip: response of the device to a force at the tip.
template <int N>
void expect_hand(Predictor<N>& predictor, const LawInput<N>& in, const Jacobian<N>& J,
                 const Levers<N>& on_tip, double hand_mass, const Proxy<N>& proxy) {
  const TipMoved tip = tip_moved(J * on_tip, J * J.transpose());
  const double K = proxy.contacts().stiffest();
  const double at_rest = resting_rate(K, tip.mass, in.encoder_step * tip.lever);
  predictor.expect_hand(on_tip, J, hand_mass, at_rest);
}

// Share of the hand's observed torque that is fed forward. The observer lags behind the hand by
// tau, so in a hand with mass m the feedforward multiplies the coupling's spring and damper by
//     (1 + tau s) / (1 - r + tau s),    r = share phi m / (M1 + m) < share phi,
// which takes off damping where proxy and hand are heavy. By Routh's criterion device and proxy do
// not swing against each other, whatever m, if
//     share phi <= b_vc (1 / (b_vc + k_vc tau) + (M1/alpha) / M2).
// ratio: M2 / M1 of every joint. No joint's inertia exceeds M1's trace, so the share fits all.
template <int N>
double fed_forward(const LawSettings& p, const LawInput<N>& in, double ratio) {
  constexpr double kSampled = 1.5;  // lag of an acceleration from sampled positions [ticks]
  const double lag = in.device.M.trace() / in.alpha + (kSampled + p.delay) * in.T;
  const double most = p.b_vc * (1 / (p.b_vc + p.k_vc * lag) + 1 / (ratio * in.alpha));
  return std::min(1.0, most * (1 + ratio) / ratio);
}

// Jump of a joint's velocity when an encoder makes a step [rad/s].
template <int N>
double jump_at_step(const Predictor<N>& predictor, const PredictorGains& gains,
                    const LawInput<N>& in) {
  if (gains.weighs()) return predictor.weighed_jump(in.encoder_step);
  return velocity_jump(gains.p, in.encoder_step, in.tick);
}

template <int N>
class Predictive final : public Law<N> {
 public:
  void start(const LawStart<N>& at) override;
  DeviceEstimate<N> locate(const LawSettings& p, const LawReading<N>& in) override;
  Vec<N> step(const LawSettings& p, const LawInput<N>& in, Proxy<N>& proxy) override;
  void applied(const Vec<N>& tau) override { predictor_.applied(tau, both_); }
  LawReport report() const override { return report_; }
  bool books_itself() const override { return true; }
  double least_left() const override { return -std::numeric_limits<double>::infinity(); }

 private:
  struct Solve;
  double held(const Vec<N>& k_vc, const Ledger<N>& ledger, const Proxy<N>& proxy,
              const TorqueLimits<N>& motors);
  void solve_together(LimitedSolve<N>& both, const ContactAnswer<N>& answer, const Motion<N>& right,
                      double T, bool resumed, Motion<N>& motion);
  bool solve_with_bodies(LimitedSolve<N>& both, double T, Motion<N>& found);
  void set_gains(const LawSettings& p, const LawInput<N>& in, const Proxy<N>& proxy,
                 const Vec<N>& weights, Solve& solve) const;
  void balance(const LawSettings& p, const LawInput<N>& in, const Proxy<N>& proxy,
               const TorqueLimits<N>& motors, double surprise);

  Predictor<N> predictor_;
  InertiaNetwork<N> network_;
  ContactSolve<N> contacts_;
  Vec<N> y_;              // the last reading [rad]
  Vec<N> slip_;           // error of its prediction [rad]
  Vec<N> tau1_;           // torque wanted for this tick [N m]
  Vec<N> cut_;            // part of tE + tL of that tick that the motors' limit cuts off [N m]
  Vec<N> wanted_;         // tE of the last tick, before any limit [N m]
  Vec<N> exchanged_;      // torque between device and proxy in that tick, within the limits [N m]
  double elapsed_ = 0;    // since the previous reading; 0 at the first [s]
  bool both_ = true;      // both predictors run
  Vec<N> b_d_;            // the damping for which quick_ is known
  bool quick_ = false;    // the device is overdamped, see dies_within_a_tick()
  bool limited_ = false;  // the last tick had motors at their limit
  bool goes_on_ = false;  // the next tick counts as limited in any case
  LawReport report_;
  Motion<N> last_;   // motion of the last tick solved together
  Vec<N> before_;    // where the proxy was a tick ago [rad]
  double held_ = 0;  // see held() [J]
  // State of the spring in the last tick without motors at their limit, see held().
  Vec<N> apart_;       // [rad]
  double spring_ = 0;  // [J]
};

// The joint system of a tick, with the mean velocities (w, u) of device and proxy unknown:
//     D0 w               = drive + tau1,               tau1 = tE + tL
//     (2/T M2 + S2) u    = momentum + tau2 + f2,
//     tE = - c v_E - s0 + C_EL v_L + (g_f - phi^T) f2 - phi^T f1_hat
//     tL = - b_w w + (I - phi^T) sigma,                sigma = C_LE v_E + u_N - K_N w
//     tau2 = - tE + phi^T sigma,
// with c = b_vc + k_vc T/2, s0 = k_vc (x1 - x2), v_E = w - u, v_L = w - phi v_E.
//
// In tau1 + tau2 = sigma - b_w w all terms that tie the two together cancel. So the proxy's rows
// are added to the device's, with w and -v_E unknown; the big numbers are then in one block of
// four:
//     [ D0 + Z2 + b_w + K_N         Z2 + C_LE                     ]
//     [ Z2 - C_LE^T + phi^T K_N     Z2 + c + phi^T C_LE - C_LE^T phi ],    Z2 = 2/T M2 + S2.
// The motors give the share `authority` a of tau1: a times the proxy's rows are added.
template <int N>
struct Predictive<N>::Solve {
  const InertiaNetwork<N>& network;
  const Mat<N>& D0;
  const Vec<N>& limit;
  double authority;
  Wide<N> phi_T, C_LE_T, impedance;
  Vec<N> drive, momentum;
  Vec<N> f1_hat;  // its share that is fed forward
  Vec<N> b_w, s0, c;
  double g_f = 0;

  Solve(const Locked<N>& d, const InertiaNetwork<N>& of_inertia, const Predictor<N>& device,
        const Proxy<N>& proxy, const LawInput<N>& in)
      : network(of_inertia),
        D0(device.D0()),
        limit(in.limit),
        authority(in.authority),
        phi_T(d.phi_T()),
        C_LE_T(d.C_LE_T(phi_T)),
        impedance(proxy.impedance(in.tick)),
        drive(device.drive()),
        momentum(proxy.momentum(in.tick)),
        f1_hat(in.f1_hat) {}

  ContactAnswer<N> system() const {
    const Wide<N>& Z2 = impedance;
    const Wide<N> C_LE = turned<N>(C_LE_T);
    Wide<N> ww = widened<N>(D0), uw = Z2 - C_LE_T;
    ww += authority * Z2;
    ww.diagonal() += authority * b_w;
    if (network.damps()) {
      const Wide<N> minus_K_N = widened<N>(-network.damping());
      ww -= authority * minus_K_N;
      take_product<N>(phi_T, minus_K_N, uw);
    }
    const Wide<N> turning = minus_product_turned<N>(C_LE_T, phi_T);  // - C_LE^T phi
    Wide<N> uu = Z2 + turning - turned<N>(turning);
    uu.diagonal() += c;
    ContactAnswer<N> answer(authority, phi_T, ww, authority * (Z2 + C_LE), uw, uu);
    answer.on_proxy.diagonal().array() += 1 - g_f;
    return answer;
  }

  Motion<N> right() const {
    const Vec<N>& u_N = network.force();
    return {drive + authority * (momentum + u_N),
            momentum + s0 + times<N>(phi_T, (u_N + f1_hat).eval())};
  }

  // Torque tE wanted between device and proxy, with its part of f2.
  Vec<N> wanted(const Motion<N>& m, const Vec<N>& f2) const {
    const Vec<N> v_E = m.w - m.u, v_L = m.w - turned_times<N>(phi_T, v_E);
    return g_f * f2 - c.cwiseProduct(v_E) - s0 - times<N>(C_LE_T, v_L) -
           times<N>(phi_T, (f2 + f1_hat).eval());
  }

  // Torque tL on the device alone.
  Vec<N> alone(const Motion<N>& m) const {
    Vec<N> sigma = turned_times<N>(C_LE_T, (m.w - m.u).eval()) + network.force();
    if (network.damps()) sigma -= network.damping() * m.w;
    return sigma - times<N>(phi_T, sigma) - b_w.cwiseProduct(m.w);
  }

  // The joint system with motors at their limit. The spring's damping is raised from c by
  // `stiffer`, so that a joint that is let go comes to rest; the proxy's damper b_v holds what no
  // motor does.
  LimitedSolve<N> limited(const Vec<N>& stiffer, const Vec<N>& b_v) const {
    const Eigen::Index n = s0.size();
    const Mat<N> I = Mat<N>::Identity(n, n);
    const Mat<N> share = narrowed<N>(phi_T), C_T = narrowed<N>(C_LE_T), C_LE = C_T.transpose();
    const Mat<N> locked_u = -C_T * share.transpose(), locked_w = -C_T - locked_u;
    const Mat<N> shaped = network.damps() ? Mat<N>(C_LE - network.damping()) : C_LE;
    const Mat<N> share_w = share * shaped, share_u = -share * C_LE;
    const Vec<N> share_N = share * network.force();
    LimitedSolve<N> s;
    s.tE = {-s0 - share * f1_hat, locked_w, locked_u};
    s.tE.on_w.diagonal() -= c + stiffer;
    s.tE.on_u.diagonal() += c + stiffer;
    s.tL = {network.force() - share_N, shaped - share_w, -C_LE - share_u};
    s.tL.on_w.diagonal() -= b_w;
    s.rest = {share_N, share_w, share_u};
    s.on_f2 = g_f * I - share;
    s.D0 = D0;
    s.impedance = narrowed<N>(impedance);
    s.impedance.diagonal() += b_v;
    s.drive = drive;
    s.momentum = momentum;
    s.limit = limit;
    s.authority = authority;
    return s;
  }
};

template <int N>
void Predictive<N>::start(const LawStart<N>& at) {
  const Vec<N> zero = Vec<N>::Zero(at.x1.size());
  predictor_.start(at.x1, at.v1, at.f1_hat);
  network_.start(at.x1.size());
  report_ = {};
  y_ = at.x1;
  slip_ = tau1_ = cut_ = wanted_ = exchanged_ = apart_ = zero;
  before_ = at.x1;
  spring_ = held_ = 0;
  limited_ = goes_on_ = false;
  elapsed_ = 0;
  b_d_ = zero;
  quick_ = false;
}

template <int N>
DeviceEstimate<N> Predictive<N>::locate(const LawSettings& p, const LawReading<N>& in) {
  elapsed_ = in.elapsed;
  both_ = p.hand_mass > 0;
  if (elapsed_ > 0) {
    slip_ = in.x1 - y_ - elapsed_ * predictor_.w();
    predictor_.correct(in.x1, elapsed_, in.encoder_step, p.gains(in.encoder_step).p, both_);
  } else {  // the first reading, perhaps not quite at the position of start()
    predictor_.begin_at(in.x1);
  }
  y_ = in.x1;
  return {predictor_.x_now(), predictor_.v_now()};
}

// Closes the books of the tick just ended, and sets the shares for the one that begins.
template <int N>
void Predictive<N>::balance(const LawSettings& p, const LawInput<N>& in, const Proxy<N>& proxy,
                            const TorqueLimits<N>& motors, double surprise) {
  Ledger<N>& ledger = *in.ledger;
  ledger.expect(p.delay, in.delay_most);
  if (elapsed_ > 0) {
    const auto sent = [&](int d) -> const Vec<N>& { return predictor_.sent(d); };
    const double given = in.authority > 0 ? given_to_bodies(proxy) : 0;
    ledger.add(y_, predictor_.x_now(), sent, in.b_d_sure, given, in.encoder_step, elapsed_);
    network_.advance(ledger.dx(), elapsed_);
    network_.lose(-cut_.dot(ledger.dx()));
  }
  ledger.settle(p.energy, held(springs(p, in.b_d), ledger, proxy, motors) + network_.storage() +
                              proxy.kinetic_energy() + proxy.contact_potential());
  if (in.armed_anew) ledger.refill();
  const bool sure = (in.b_d_sure.array() >= in.b_d.array()).all();
  if (!sure && in.authority > 0) ledger.forgive_at_rest(in.encoder_step, in.tick);
  ledger.govern(proxy.f(), slip_, surprise, elapsed_ > 0 ? elapsed_ : in.tick);
  report_.reserve = ledger.reserve();
  report_.contact_governor = ledger.contact();
  report_.damping_governor = ledger.damping();
  report_.torque_governor = ledger.torque();
}

// Energy stored between device and proxy, which the motors may return to the hand. While joints are
// at their limits, they return it as constant torques do. The direction of a force that the tip's
// limit bounds changes as the proxy slides along walls, so no function of the place tells what it
// returns: all that was put in.
template <int N>
double Predictive<N>::held(const Vec<N>& k_vc, const Ledger<N>& ledger, const Proxy<N>& proxy,
                           const TorqueLimits<N>& motors) {
  const Vec<N> apart = y_ - proxy.x();
  const bool tip = motors.J != nullptr;
  const double spring =
      spring_energy<N>(k_vc, apart, tip ? motors.reached(k_vc.cwiseProduct(apart)) : motors.joints);
  if (!limited_) {
    apart_ = apart;
    spring_ = held_ = spring;
  } else if (!tip) {
    const double since = spring_ - limit_energy<N>(apart_, motors.joints);
    held_ = std::max(spring, limit_energy<N>(apart, motors.joints) + since);
  } else {
    const Vec<N> moved = proxy.x() - before_;
    held_ = std::max(spring, held_ + exchanged_.dot(moved - ledger.torque() * ledger.dx()));
  }
  if (tip) before_ = proxy.x();
  return held_;
}

// Sets springs, dampers and what the ledger leaves of the rest. weights: see gain_weights().
template <int N>
void Predictive<N>::set_gains(const LawSettings& p, const LawInput<N>& in, const Proxy<N>& proxy,
                              const Vec<N>& weights, Solve& solve) const {
  solve.f1_hat *= fed_forward(p, in, proxy.ratio());
  solve.c = (p.b_vc + p.k_vc * in.tick / 2) * weights;
  solve.s0 = weights.cwiseProduct(p.k_vc * (predictor_.x() - proxy.x()));
  solve.g_f = in.ledger->contact();
  solve.b_w = p.b_v * weights;
  if (!proxy.contacts().engaged()) {
    solve.b_w -= in.ledger->damping() * (1 - p.damping_share(p.eta)) * (in.b_d + solve.b_w);
  }
}

template <int N>
Vec<N> Predictive<N>::step(const LawSettings& p, const LawInput<N>& in, Proxy<N>& proxy) {
  const double T = in.tick;
  if (in.b_d != b_d_) quick_ = dies_within_a_tick<N>(in.device.M, in.b_d, T);
  b_d_ = in.b_d;
  const PredictorGains gains = p.gains(in.encoder_step);
  Jacobian<N> J;
  const Arm<N>& arm = proxy.arm();
  arm.point_jacobian(in.frames, arm.dof() - 1, arm.tip(in.frames), J);
  predictor_.model(in.device.M, in.device.C, in.b_d, J, T, gains.p, gains.mu, p.hand_mass, p.delay,
                   quick_);
  proxy.look(T);
  const Locked<N> d(in.device.M, in.device.C, proxy.M(), proxy.C());
  const Levers<N> on_tip =
      d.M_L_factor.solve(Levers<N>(J.transpose()));  // response to a force at the tip
  if (gains.weighs()) expect_hand(predictor_, in, J, on_tip, p.hand_mass, proxy);
  const TorqueLimits<N> motors(in.limit, J, in.tip_force);
  balance(p, in, proxy, motors, std::min(kSurprise, kPushed * on_tip.norm()));
  const AddedMass added = added_mass(p.eta, in.delay_most, T, proxy.ratio());
  network_.set(added, d.M_L, in.ledger->damping(), T, p.band);
  // The velocity predicted for a late torque is no newer knowledge: the present one damps.
  if (p.delay > 0) network_.damp_now(predictor_.v_now());
  Solve solve(d, network_, predictor_, proxy, in);
  const double share = in.ledger->torque();
  solve.authority *= share;
  const Vec<N> weights = gain_weights(p, in.b_d);
  set_gains(p, in, proxy, weights, solve);

  ContactAnswer<N> answer = solve.system();
  Motion<N> motion = answer.solve(solve.right());
  contacts_.collect(proxy.contacts(), arm, proxy.frames(), motion.u, T);
  if (contacts_.any()) {
    answer.inertia = &d.M_L_factor;
    answer.damping = gains.damping;
    answer.jump = jump_at_step(predictor_, gains, in);
    answer.most_damping = kMostDamping;
  }
  const bool resumed = goes_on_;
  bool limited = resumed, settled = true;
  Vec<N> f2;
  if (!resumed) {
    if (contacts_.any()) {
      contacts_.solve(answer, T, motion);
      settled = contacts_.settled();
    }
    f2 = contacts_.f2(in.b_d.size());
    wanted_ = solve.wanted(motion, f2);
    limited = (wanted_.array().abs() > in.limit.array()).any() || motors.tip_cuts(wanted_);
    const Vec<N> given = clip<N>(wanted_, in.limit) + solve.alone(motion);
    tau1_ = motors.within(given);
    cut_ = given - tau1_;
  }
  goes_on_ = false;
  report_.solved = TickSolve::usual;
  if (limited || !settled) {
    report_.solved = limited ? TickSolve::limited : TickSolve::together;
    const double stiffer = limited ? std::max(0.0, p.k_vc * T / 2 - p.b_vc) : 0;
    LimitedSolve<N> both = solve.limited(stiffer * weights, (limited ? p.b_v : 0) * weights);
    if (limited) both.limit = motors.along(wanted_);
    solve_together(both, answer, solve.right(), T, resumed, motion);
    f2 = both.f2;
    wanted_ = both.wanted();
    exchanged_ = both.p;
    tau1_ = motors.within(both.tau1);
    cut_ = both.given - both.tau1;
    const Vec<N> apart = predictor_.x() - proxy.x() + T * (motion.w - motion.u);
    const Vec<N> pull = p.k_vc * weights.cwiseProduct(apart).cwiseAbs();
    goes_on_ =
        limited && (both.at_limit() || (pull.array() > kStillPulled * in.limit.array()).any());
  }
  limited_ = limited;
  contacts_.finish(proxy.contacts());
  proxy.step(T, motion.u, f2);
  return share * tau1_;
}

// Solves contacts and motors together. motion: in, a first guess; out, the solution. `resumed`: the
// last tick's motion is a better guess, and the contacts have not been solved yet.
template <int N>
void Predictive<N>::solve_together(LimitedSolve<N>& both, const ContactAnswer<N>& answer,
                                   const Motion<N>& right, double T, bool resumed,
                                   Motion<N>& motion) {
  contacts_.prepare(answer, T);
  Motion<N> found = resumed ? last_ : motion;
  bool settled = solve_with_bodies(both, T, found);
  if (!settled && resumed) {
    found = answer.solve(right);
    if (contacts_.any()) contacts_.solve(answer, T, found);
    contacts_.prepare(answer, T);
    settled = solve_with_bodies(both, T, found);
  }
  if (!settled) {
    contacts_.hold_bodies();
    both.stand_still(contacts_, T, found);
    ++report_.unsettled;
    report_.solved = TickSolve::stood_still;
  }
  motion = last_ = found;
}

// Solves bodies of the scene in turn with the rest: each turn they get the forces found, and answer
// with their motion.
template <int N>
bool Predictive<N>::solve_with_bodies(LimitedSolve<N>& both, double T, Motion<N>& found) {
  for (int turn = 0; turn < kMostTurns; ++turn) {
    if (!both.solve(contacts_, T, found)) return false;
    if (contacts_.push_bodies(turn) < kSameForce) return true;
  }
  return false;
}

}  // namespace

template <int N>
std::unique_ptr<Law<N>> PredictiveLaw::make() {
  return std::make_unique<Predictive<N>>();
}

template std::unique_ptr<Law<3>> PredictiveLaw::make();
template std::unique_ptr<Law<7>> PredictiveLaw::make();
template std::unique_ptr<Law<kAnyDof>> PredictiveLaw::make();

}  // namespace limpid
