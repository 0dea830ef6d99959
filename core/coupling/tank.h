// The standard coupling with an energy tank on each side, after the two-layer control of Franken et
// al. (2011).
//
// Energy that a side gives comes out of its tank, energy it takes goes in; energy sent to the other
// side leaves one tank before it enters the other. So both together never give more than they held
// at the start and took in, however the link delays, loses or reorders packets.
//
// The accounts hold what the motors and the proxy's drive really did. Two dampers that nothing
// commands count as intake, as they do in E_c: the device's own, as far as it is sure, and the
// proxy's.
#pragma once

#include <array>
#include <limits>

#include "core/coupling/standard.h"

namespace limpid {

// The tank of the device's side. The motors' delay may be unknown: each possible delay has its
// account of energy spent, and the largest counts.
template <int N>
class DeviceTank {
 public:
  void start(const Vec<N>& x1, double energy);  // [J]
  // Books the tick of length T that just ended, with the reading x1 after it. `damping`: as far as
  // it is sure [N m s/rad]; q: the encoders' step [rad]; `most`: the tank keeps no more [J].
  void settle(const Vec<N>& x1, const Vec<N>& damping, double q, double T, double most);
  // Sets the least and the largest delay between command and motor [ticks].
  void expect(int least, int most);
  void add(double energy) { in_ += energy; }
  // Takes the torque sent for the tick that begins [N m].
  void sent(const Vec<N>& torque);
  double energy() const { return in_ - out_; }  // [J]

  // Largest share of a torque that the tank can pay for in the coming tick of length T [s]. It
  // covers a device that goes on as fast, that gains as much speed again, or that nothing holds but
  // its inertia M. Torques on their way to the motors are paid for first. None counts as taking
  // energy in: a device that trembles is on its way back by then.
  double share(const Vec<N>& torque, const Mat<N>& M, double T) const;

 private:
  double in_ = 0, out_ = 0;                     // energy in and out so far [J]
  std::array<double, kMostDelay + 1> spent_{};  // by delay [J]
  int least_ = 0, most_ = 0;
  Vec<N> x1_, dx_, change_;                     // last reading, motion, change of motion [rad]
  std::array<int, kMaxDof> still_{};            // ticks since a joint's reading changed
  std::array<Vec<N>, kMostDelay + 1> torques_;  // torques that were sent [N m]
  std::size_t newest_ = 0;
};

template <int N>
class TankLaw::Of {
 public:
  void start(const LawStart<N>& at);
  template <class P>
  DeviceEstimate<N> locate(const P&, const LawReading<N>& in) {
    elapsed_ = in.elapsed;
    return {in.x1, in.v1};
  }
  // p: Settings, a SpringDamper, and the motors' known delay.
  template <class P>
  Vec<N> step(const P& p, const LawInput<N>& in, Proxy<N>& proxy) {
    return step(p, p, p.delay, in, proxy);
  }
  void applied(const Vec<N>& torque) { device_.sent(torque); }
  LawReport report() const;
  static constexpr bool kKeepsLedger = false;
  static constexpr double kLeastLeft = -std::numeric_limits<double>::infinity();

 private:
  Vec<N> step(const Settings& p, const SpringDamper& c, int delay, const LawInput<N>& in,
              Proxy<N>& proxy);
  void settle(const Settings& p, const SpringDamper& c, int delay, const LawInput<N>& in,
              const Proxy<N>& proxy);
  void move(const Settings& p, const SpringDamper& c, const LawInput<N>& in,
            const FromDevice<N>& device, Proxy<N>& proxy);
  Vec<N> pull(const Settings& p, const SpringDamper& c, const LawInput<N>& in,
              const FromProxy<N>& proxy);
  double on_its_way() const { return (sent1_ - got2_) + (sent2_ - got1_); }

  DeviceTank<N> device_;
  double proxy_ = 0;             // energy in the tank of the proxy's side [J]
  double work2_ = 0;             // work of tau2 over the last tick [J]
  double sent1_ = 0, got2_ = 0;  // energy from device to proxy, in all so far [J]
  double sent2_ = 0, got1_ = 0;  // energy from proxy to device
  double reserve_ = 0;           // energy in both tanks and between them when the tick began [J]
  double left_ = std::numeric_limits<double>::infinity();  // of an earlier part of the run [J]
  bool fresh_ = true, owed_ = false, takes_over_ = false;  // see LawStart
  double elapsed_ = 0;  // since the previous reading; 0 at the first [s]
  double freely_ = 1;   // the proxy's damping over that with its tank's damper [-]
  double share_ = 1;    // share of the device's torque [-]
};

extern template class TankLaw::Of<3>;
extern template class TankLaw::Of<7>;
extern template class TankLaw::Of<kAnyDof>;

}  // namespace limpid
