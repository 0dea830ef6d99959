// Whether the loop chatters: device and proxy shake against each other, and the coupling feeds it.
#pragma once

#include <optional>

#include "app/plot/history.h"

namespace limpid {

// Chatter is seen in stretches of a quarter of a second. In each of three that follow each other
//
// - the coordination error of the joint where it is largest goes to and fro faster than a hand can
//   shake, which is up to some 12 Hz;
// - the coupling gives energy: E_c grows, also with what its spring holds added. Under a passive
//   coupling the sum never grows, however quickly something is touched, rubbed or let go: what the
//   spring gives back it held before. Where motors at their limit keep it from holding that much,
//   E_c by itself does not grow.
//
// Motors at their limit are no excuse here, as they are for EnergyAccount: a hand that presses hard
// and still gains nothing by them.
class Chatter {
 public:
  static constexpr double kStretch = 0.25;  // [s]
  static constexpr int kStretches = 3;      // that follow each other
  static constexpr double kFrequency = 16;  // [Hz]
  static constexpr double kPower = 0.005;   // that is given, at the least [W]

  // Looks at the samples up to `end` that were not looked at yet. The history has the channels of
  // TraceChannels of an arm of `dof` joints, of this run from `first` on. k_vc: the coupling's
  // spring [N m/rad]; a change of it is a new beginning.
  void follow(const History& history, SampleIndex end, int first, int dof, double k_vc);
  // Looks at what comes as if there had been nothing.
  void start_over();

  // In the newest stretches.
  bool there() const { return in_a_row_ >= kStretches; }
  double power() const { return power_; }          // given in the last stretch [W]
  double frequency() const { return frequency_; }  // of the error then [Hz]

 private:
  struct Stretch {
    double energy;     // mean of E_c [J]
    double held;       // mean of what the spring holds [J]
    double frequency;  // [Hz]
  };
  static Stretch measure(const History& history, SampleIndex from, SampleIndex to, int first,
                         int dof, double k_vc);

  SampleIndex next_ = 0;
  double k_vc_ = 0;
  std::optional<Stretch> before_;
  int in_a_row_ = 0;
  double power_ = 0, frequency_ = 0;
};

}  // namespace limpid
