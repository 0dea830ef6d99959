// Detector of chatter: device and proxy shake against each other, and the coupling feeds it.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "app/plot/history.h"

namespace limpid {

// Looks for chatter in stretches of a quarter of a second. In each of three successive stretches
//
// - the largest coordination error of a joint goes to and fro faster than a hand can shake (up to
//   some 12 Hz);
// - the coupling gives energy: E_c grows, also with the energy of its spring added. Under a passive
//   coupling the sum never grows, however quickly something is touched, rubbed or let go: the
//   spring gives back only energy that it held. If motors at their limit keep the spring from
//   holding that much, E_c by itself does not grow.
//
// Motors at their limit are no excuse here, unlike for EnergyAccount: a hand that presses hard and
// still gains nothing by them.
class Chatter {
 public:
  static constexpr double kStretch = 0.25;  // duration of a stretch [s]
  static constexpr int kStretches = 3;      // successive stretches that count as chatter
  static constexpr double kFrequency = 16;  // least frequency of the error [Hz]
  static constexpr double kPower = 0.005;   // least power that the coupling gives [W]

  // Looks at new samples up to `end`. The history has the channels of TraceChannels, from `first`
  // on those of this run. springs: the coupling's, see coupling_springs(); a change of them starts
  // over.
  void follow(const History& history, SampleIndex end, int first, const Eigen::VectorXd& springs);
  // Forgets all stretches so far, and samples before `next`.
  void start_over(SampleIndex next);

  // Returns whether the newest stretches chatter.
  bool there() const { return in_a_row_ >= kStretches; }
  double power() const { return power_; }          // given in the last stretch [W]
  double frequency() const { return frequency_; }  // of the error in the last stretch [Hz]

 private:
  struct Stretch {
    double energy;     // mean of E_c [J]
    double held;       // mean energy of the spring [J]
    double frequency;  // of the error [Hz]
  };
  static Stretch measure(const History& history, SampleIndex from, SampleIndex to, int first,
                         const Eigen::VectorXd& springs);

  SampleIndex next_ = 0;
  Eigen::VectorXd springs_;
  std::optional<Stretch> before_;
  int in_a_row_ = 0;
  double power_ = 0, frequency_ = 0;
};

// Detector of chatter at the place where a recording is played, with jumps to and fro.
class PlayedChatter {
 public:
  // Returns whether a lane chatters at the sample `at`; as Chatter::follow(). A jump counts from
  // two seconds before its end.
  bool there(const History& history, SampleIndex at, int first, const Eigen::VectorXd& springs);

 private:
  Chatter chatter_;
  SampleIndex seen_ = 0;  // samples looked at
};

}  // namespace limpid
