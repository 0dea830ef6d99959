// A tick of the loop: the paper, from a device's reading to the motors' torque.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/coupling/coupling.h"
#include "core/coupling/force_observer.h"
#include "core/coupling/link.h"
#include "core/math/sizes.h"
#include "core/tick/compensation.h"
#include "core/tick/motor_stage.h"
#include "core/tick/motor_warmth.h"
#include "core/tick/parameters.h"
#include "core/tick/row.h"
#include "core/tick/safety.h"
#include "core/touch/proxy.h"

namespace limpid {

// The paper's controller energy E_c, kept twice. E_c = sum over ticks of tau1 . dx1 + tau2 . dx2.
// Commanded: motors and proxy, as instruments see it. Total: with the device's own damping, -b_d/T
// dx1 . dx1 a tick.
template <int N>
struct EnergyBooks {
  double commanded = 0;     // [J]
  double total = 0;         // [J]
  double port = 0;          // of motors and own damping alone: given to the human [J]
  double compensation = 0;  // of `commanded`: for the device's own forces and the excitation [J]
  double contact = 0;       // work of the contacts on the proxy [J]

  // tau1: motor torque held over the tick; dx: motion over it; b_d: the device's damping.
  void add(const Vec<N>& tau1, const Vec<N>& dx1, const Vec<N>& tau2, const Vec<N>& dx2,
           const Vec<N>& b_d, double T) {
    const double work = tau1.dot(dx1) + tau2.dot(dx2);
    const double damped = b_d.cwiseProduct(dx1).dot(dx1) / T;
    commanded += work;
    total += work - damped;
    port += tau1.dot(dx1) - damped;
  }

  // Adds the work of contacts. A contact is a spring: its work and its stored energy cancel while
  // it lasts. Making and breaking one within a tick, and slipping, leave a remainder.
  void add_contact(const Vec<N>& f2, const Vec<N>& dx2) { contact += f2.dot(dx2); }
  double contact_gain(double stored, double stored_at_first, double given) const {
    return contact + stored - stored_at_first + given;
  }
};

// Reading of a device at t_k.
template <int N>
struct Reading {
  Vec<N> measured;  // x1_k as the encoders give it [rad]
  Vec<N> x, v;      // true state if known, else as measured [rad, rad/s]
  DeviceHealth health{};
  int periods = 1;  // ticks since the previous reading; more than 1 after a late tick
  double dt = 0;    // measured time since the previous reading [s]; 0: the nominal time
  // Torque applied since the last reading, if it is known to differ from the command [N m].
  std::optional<Vec<N>> acted{};
  bool magnet = false;  // the tip is to hold a magnetic body near it
  BodyPull pull{};      // pull on a body from outside
  double warmth = 0;    // of the hottest motor, as the device says it [-]
  // Force that the motors are to make at the tip besides, to measure the grip [N].
  Vec3 excitation = Vec3::Zero();
};

// Start of a loop.
template <int N>
struct Start {
  Vec<N> x1, v1;      // device [rad, rad/s]
  Vec<N> x2, v2;      // proxy
  Vec<N> f1_hat;      // estimate of the human torque [N m]
  bool armed = true;  // full force from the first tick on; not where motors are guarded
  // Energy that the laws with an account may still give the human; they start with no more [J].
  double reserve = std::numeric_limits<double>::infinity();
  std::span<const double>
      world{};        // state of all bodies, see BodyWorld::write(); empty: as in the scene
  bool owed = false;  // the human has not put in the energy that is stored
  std::span<const double> warmth{};  // of each motor [-]; empty: cold

  static Start at_rest(const Vec<N>& x) {
    const Vec<N> zero = Vec<N>::Zero(x.size());
    Start start{x, zero, x, zero, zero};
    start.owed = true;
    return start;
  }
};

// State between two ticks, and the tick itself. Allocates when constructed, never after.
template <int N>
class Tick {
 public:
  Tick(const ArmDescription& arm, const Scene& scene);

  void start(const Parameters& p, const Start<N>& start);
  // Like start(), but keeps the force as it is.
  void restart_here(const Parameters& p, const Start<N>& start);
  void limit(const SafetyLimits& limits) { safety_.limit(limits); }

  // Runs tick k and writes its row, except for what only the device and the clock know (hand,
  // timing). Returns the motor torque to be held until t_k+1 [N m].
  const Vec<N>& run(const Parameters& given, const Reading<N>& in, ForceRequest wish,
                    std::span<double> row);

  // Changes the scene between two ticks: takes `contacts` and gives back the old ones. Allocates
  // nothing; the torque moves to its new value at a bounded rate.
  void exchange(std::unique_ptr<Contacts<N>>& contacts);

  const Proxy<N>& proxy() const { return proxy_; }
  const Vec<N>& estimate() const { return f1_hat_; }           // f1_hat of the last tick [N m]
  double reserve() const { return coupling_.reserve(); }       // see Start [J]
  const Vec<N>& warmth() const { return warmth_.modelled(); }  // of each motor, see Start [-]
  Vec3 tip() const { return arm_.tip(frames_); }  // tip of the device as the law locates it [m]
  Vec3 tip_at(const Vec<N>& x) const { return arm_.tip_at(x); }
  // True if no force is fading, no coupling is being switched, and the contacts remember nothing
  // that a start from here would not find.
  bool steady() const {
    return gate_.steady() && motors_.steady() && compensation_.steady() &&
           proxy_.contacts().recoverable();
  }
  // True if the command was not finite: the loop is unstable, force is off.
  bool diverged() const { return diverged_; }
  const ForceGate& force() const { return gate_; }
  const RowLayout& layout() const { return layout_; }

 private:
  void warm_up(const Parameters& p, const Reading<N>& in);
  double tip_force_left(bool guarded) const;
  void begin_anew(const Reading<N>& in);
  void bring_proxy(const Vec<N>& x, const Parameters& p);
  Vec<N> own_forces(const Parameters& p, const DeviceEstimate<N>& at, const Reading<N>& in,
                    double T);
  void switch_law(CouplingKind to, const Vec<N>& x1);
  void start_law(const LawStart<N>& at);
  void pass_on(const Parameters& p, const Reading<N>& in, ForceRequest wish, double put_out,
               double T);
  void close_books(const Reading<N>& in, double T);
  void write_row(const Parameters& p, const Reading<N>& in, std::span<double> row) const;
  void write_contacts(std::span<double> row) const;
  void write_bodies(std::span<double> row);

  RowLayout layout_;
  Arm<N> arm_;
  Vec<N> arm_damping_, arm_limit_, arm_friction_;  // from the arm's file
  std::optional<double> arm_delay_;                // as identified [s]
  typename Arm<N>::Frames frames_;
  Dynamics<N> device_;
  VelocityEstimator<N> velocity_;
  ForceObserver<N> observer_;
  Proxy<N> proxy_;
  ProxyLink<N> link_;
  Coupling<N> coupling_;
  Compensation<N> compensation_;
  MotorStage<N> motors_;
  MotorWarmth<N> warmth_;
  Safety<N> safety_;
  ForceGate gate_;
  Jacobian<N> J_;  // of the device's tip
  EnergyBooks<N> books_;

  // State at the present tick's start, for the row.
  Vec<N> x2_, v2_, f1_hat_, command_, loads_;
  double kinetic_ = 0, potential_ = 0, first_potential_ = 0;
  double to_bodies_ = 0;  // given to the scene's bodies since the start [J]
  double pulled_ = 0;     // likewise by pulls from outside [J]
  // State of the last tick, for the books and for the delayed terms of (1).
  Vec<N> x1_before_, tau1_, vbar2_, b_d_, limit_;
  CouplingKind kind_ = CouplingKind::standard;
  bool barred_ = false;       // no force may leave, even if armed
  bool unbarred_ = false;     // force may leave again from the coming tick on
  bool restarted_ = false;    // a recording begins with this tick
  std::uint64_t k_ = 0;       // ticks run
  std::uint64_t period_ = 0;  // number of the present tick, with those given up
  bool diverged_ = false;
};

extern template class Tick<3>;
extern template class Tick<7>;
extern template class Tick<kAnyDof>;

// Values of all joints: the setting, or the arm's own where the setting is NaN.
template <int N>
Vec<N> resolve(double setting, const Vec<N>& of_arm) {
  return std::isnan(setting) ? of_arm : Vec<N>::Constant(of_arm.size(), setting);
}

}  // namespace limpid
