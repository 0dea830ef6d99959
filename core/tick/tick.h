// One tick of the loop: the paper from the reading of a device to the torque of its motors.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/coupling/coupling.h"
#include "core/coupling/force_observer.h"
#include "core/math/sizes.h"
#include "core/tick/compensation.h"
#include "core/tick/motor_stage.h"
#include "core/tick/parameters.h"
#include "core/tick/row.h"
#include "core/tick/safety.h"
#include "core/touch/proxy.h"

namespace limpid {

// The paper's controller energy E_c, kept twice.

// E_c = sum over ticks of tau1 . dx1 + tau2 . dx2. Commanded: motors and proxy, what instruments
// see. Total: with the device's own damping, -b_d/T dx1 . dx1 a tick.
template <int N>
struct EnergyBooks {
  double commanded = 0;     // [J]
  double total = 0;         // [J]
  double port = 0;          // of motors and own damping alone: what the human was given [J]
  double compensation = 0;  // of commanded, what the motors gave for the device's own forces [J]
  double contact = 0;       // work of the contacts on the proxy [J]

  // tau1 the motor torque held over the tick, dx the motion over it, b_d the device's damping.
  void add(const Vec<N>& tau1, const Vec<N>& dx1, const Vec<N>& tau2, const Vec<N>& dx2,
           const Vec<N>& b_d, double T) {
    const double work = tau1.dot(dx1) + tau2.dot(dx2);
    const double damped = b_d.cwiseProduct(dx1).dot(dx1) / T;
    commanded += work;
    total += work - damped;
    port += tau1.dot(dx1) - damped;
  }

  // A contact is a spring: what it gave and still stores comes to nothing while it lasts. Making
  // and breaking it within a tick, and slipping, leave something over.
  void add_contact(const Vec<N>& f2, const Vec<N>& dx2) { contact += f2.dot(dx2); }
  double contact_gain(double stored, double stored_at_first, double given) const {
    return contact + stored - stored_at_first + given;
  }
};

// What a device says at t_k.
template <int N>
struct Reading {
  Vec<N> measured;  // x1_k as the encoders give it [rad]
  Vec<N> x, v;      // true state if it is known, else as measured [rad, rad/s]
  DeviceHealth health{};
  int periods = 1;  // since the reading before, in ticks; more than 1 after a late one
  double dt = 0;    // the same as it really passed [s]; 0: as long as it should be
  // That the motors gave since, where it is known to differ from what was sent [N m].
  std::optional<Vec<N>> acted{};
  bool magnet = false;  // the tip picks up what it may
  BodyPull pull{};      // what is pulled on besides
};

// Where a loop starts.
template <int N>
struct Start {
  Vec<N> x1, v1;      // device [rad, rad/s]
  Vec<N> x2, v2;      // proxy
  Vec<N> f1_hat;      // estimate of the human torque [N m]
  bool armed = true;  // at full force from the first tick on; not where motors are guarded
  // What the human may still be given by laws that account for it; they start with no more [J].
  double reserve = std::numeric_limits<double>::infinity();
  std::span<const double>
      world{};  // of all bodies, see BodyWorld::write(); empty: as the scene has it

  static Start at_rest(const Vec<N>& x) {
    const Vec<N> zero = Vec<N>::Zero(x.size());
    return {x, zero, x, zero, zero};
  }
};

// Everything between two ticks, and the tick itself. Allocates when constructed, never after.
template <int N>
class Tick {
 public:
  Tick(const ArmDescription& arm, const Scene& scene);

  void start(const Parameters& p, const Start<N>& start);
  // The same, but for the force: it goes on as it is.
  void restart_here(const Parameters& p, const Start<N>& start);
  void limit(const SafetyLimits& limits) { safety_.limit(limits); }

  // Runs tick k and writes its row, except for what only the device and the clock know (hand,
  // timing). Returns the motor torque to be held until t_k+1 [N m].
  const Vec<N>& run(const Parameters& given, const Reading<N>& in, ForceRequest wish,
                    std::span<double> row);

  // Another scene, between two ticks: takes `contacts` in and gives the old ones out. Allocates
  // nothing; the torque gets to what it now is at a bounded rate.
  void exchange(std::unique_ptr<Contacts<N>>& contacts);

  const Proxy<N>& proxy() const { return proxy_; }
  const Vec<N>& estimate() const { return f1_hat_; }      // f1_hat of the last tick [N m]
  double reserve() const { return coupling_.reserve(); }  // see Start [J]
  Vec3 tip() const { return arm_.tip(frames_); }  // where the law takes the device to be [m]
  Vec3 tip_at(const Vec<N>& x) const { return arm_.tip_at(x); }
  // No force is fading, no coupling being switched, and the contacts remember nothing that a new
  // start here would not find.
  bool steady() const {
    return gate_.steady() && motors_.steady() && compensation_.steady() &&
           proxy_.contacts().recoverable();
  }
  // The command was not finite: the loop is unstable, force is off.
  bool diverged() const { return diverged_; }
  const ForceGate& force() const { return gate_; }
  const RowLayout& layout() const { return layout_; }

 private:
  double tip_force_left(bool guarded) const;
  void begin_anew(const Reading<N>& in);
  void bring_proxy(const Vec<N>& x, const Parameters& p);
  Vec<N> own_forces(const Parameters& p, const DeviceEstimate<N>& at, double T);
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
  Vec<N> arm_damping_, arm_limit_, arm_friction_;  // of the arm's file
  std::optional<double> arm_delay_;                // as it was identified [s]
  typename Arm<N>::Frames frames_;
  Dynamics<N> device_;
  VelocityEstimator<N> velocity_;
  ForceObserver<N> observer_;
  Proxy<N> proxy_;
  ProxyLink<N> link_;
  Coupling<N> coupling_;
  Compensation<N> compensation_;
  MotorStage<N> motors_;
  Safety<N> safety_;
  ForceGate gate_;
  Jacobian<N> J_;  // of the device's tip
  EnergyBooks<N> books_;

  // At the present tick's start, for the row:
  Vec<N> x2_, v2_, f1_hat_, command_, loads_;
  double kinetic_ = 0, potential_ = 0, first_potential_ = 0;
  double to_bodies_ = 0;  // given to what moves in the scene, since the start [J]
  double pulled_ = 0;     // the same, by who pulls on it from outside [J]
  // Of the last tick, for the books and for the delayed terms of (1):
  Vec<N> x1_before_, tau1_, vbar2_, b_d_, limit_;
  CouplingKind kind_ = CouplingKind::standard;
  bool fresh_law_ = false;    // it took over at this tick
  bool barred_ = false;       // no force may leave, whoever arms it
  bool unbarred_ = false;     // it may again, from the coming tick on
  bool restarted_ = false;    // a recording begins with this tick
  std::uint64_t k_ = 0;       // ticks run
  std::uint64_t period_ = 0;  // of the present tick; the same unless ticks were given up
  bool diverged_ = false;
};

extern template class Tick<3>;
extern template class Tick<7>;
extern template class Tick<kAnyDof>;

// A joint value given for all joints, or the arm's own where it is left to the arm.
template <int N>
Vec<N> resolve(double setting, const Vec<N>& of_arm) {
  return std::isnan(setting) ? of_arm : Vec<N>::Constant(of_arm.size(), setting);
}

}  // namespace limpid
