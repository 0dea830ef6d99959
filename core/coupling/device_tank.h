// Energy tank of the device's side, see tank.h.
#pragma once

#include <array>

#include "core/coupling/law_info.h"
#include "core/math/sizes.h"

namespace limpid {

// The tank of the device's side. The motors' delay may be unknown: each possible delay has its
// account of energy spent, and the largest counts.
template <int N>
class DeviceTank {
 public:
  void start(const Vec<N>& x1, double energy);  // [J]
  // Books the tick of length T that just ended, with the reading x1 after it. `damping`: as far as
  // it is sure [N m s/rad]; q: the encoders' step [rad]; `most`: the tank keeps no more [J]. Work
  // counts along within_cells().
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
  Vec<N> z_;                                    // path within the cells of the readings [rad]
  std::array<Vec<N>, kMostDelay + 1> torques_;  // torques that were sent [N m]
  std::size_t newest_ = 0;
};

extern template class DeviceTank<3>;
extern template class DeviceTank<7>;
extern template class DeviceTank<kAnyDof>;

}  // namespace limpid
