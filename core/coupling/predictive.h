// The predictive coupling.
//
// Device and proxy are solved together for their mean velocities over the coming tick, so that
// walls are as stiff as set. Small passive networks shape the felt inertia instead of the observed
// force. Motor limits, several contacts and friction enter the same solve. A ledger bounds the
// energy that the human is given.
#pragma once

#include "core/coupling/decomposition.h"
#include "core/coupling/inertia_network.h"
#include "core/coupling/laws.h"
#include "core/coupling/ledger.h"
#include "core/coupling/limited_solve.h"
#include "core/coupling/predictor.h"
#include "core/coupling/standard.h"

namespace limpid {

template <int N>
class PredictiveLaw::Of {
 public:
  void start(const LawStart<N>& at);
  template <class P>
  DeviceEstimate<N> locate(const P& p, const LawReading<N>& in) {
    return locate(static_cast<const Settings&>(p), in);
  }
  template <class P>
  Vec<N> step(const P& p, const LawInput<N>& in, Proxy<N>& proxy) {
    return step(p.eta, p, p, in, proxy);
  }
  void applied(const Vec<N>& tau);
  const LawReport& report() const { return report_; }
  static constexpr bool kKeepsLedger = true;
  static constexpr double kLeastLeft = -std::numeric_limits<double>::infinity();

 private:
  struct Solve;
  DeviceEstimate<N> locate(const Settings& p, const LawReading<N>& in);
  Vec<N> step(double eta, const Settings& p, const SpringDamper& c, const LawInput<N>& in,
              Proxy<N>& proxy);
  double held(double k_vc, const Vec<N>& apart);
  void solve_together(LimitedSolve<N>& both, const ContactAnswer<N>& answer, const Motion<N>& right,
                      double T, bool resumed, Motion<N>& motion);
  bool solve_with_bodies(LimitedSolve<N>& both, double T, Motion<N>& found);
  void balance(const Settings& p, const SpringDamper& c, const LawInput<N>& in,
               const Proxy<N>& proxy, double surprise);

  Predictor<N> predictor_;
  InertiaNetwork<N> network_;
  ContactSolve<N> contacts_;
  Vec<N> y_;              // the last reading [rad]
  Vec<N> slip_;           // error of its prediction [rad]
  Vec<N> tau1_;           // torque wanted for this tick [N m]
  Vec<N> cut_;            // part of tE + tL of that tick that the motors' limit cuts off [N m]
  Vec<N> wanted_;         // tE of the last tick, before any limit [N m]
  Vec<N> limit_;          // limits of the joints in that tick, reduced by the tip's limit [N m]
  double elapsed_ = 0;    // since the previous reading; 0 at the first [s]
  bool both_ = true;      // both predictors run
  Vec<N> b_d_;            // the damping for which quick_ is known
  bool quick_ = false;    // the device is overdamped, see dies_within_a_tick()
  bool limited_ = false;  // the last tick had motors at their limit
  bool goes_on_ = false;  // the next tick counts as limited in any case
  LawReport report_;
  Motion<N> last_;  // motion of the last tick solved together
  // State of the spring in the last tick without motors at their limit, see held().
  Vec<N> apart_;       // [rad]
  double spring_ = 0;  // [J]
};

extern template class PredictiveLaw::Of<3>;
extern template class PredictiveLaw::Of<7>;
extern template class PredictiveLaw::Of<kAnyDof>;

}  // namespace limpid
