// Restitution: the part of its speed that a body keeps in an impact.
#pragma once

#include <cmath>
#include <numbers>

namespace limpid {

// An impact at a contact, from the tick in which things meet until they part. Its spring takes and
// gives energy without loss. In the tick in which the approach turns into parting, speed
// and depth are multiplied by the restitution e: from there on all goes on e times as fast, for any
// mass, stiffness and tick. An impact lasts no longer than half a swing of mass and spring: what
// presses longer is at rest.
class Impact {
 public:
  static constexpr double kSlowest = 0.02;  // speed at which things meet without impact [m/s]

  // Begins a tick with the force of the last one [N] and the speed of approach [m/s].
  void begin(double force, double approach) {
    approach_ = approach;
    if (force == 0) left_ = approach > kSlowest ? kNew : kNone;
  }
  // True while the contact has no damper.
  bool going() const { return left_ != kNone; }
  // True if the speed is multiplied in case that the parts now part.
  bool may_turn() const { return left_ > 0 && approach_ > 0; }
  // Ends a tick with the force [N]. m: mass that the contact moves [kg]; K: its stiffness [N/m].
  void finish(double force, double m, double K, double T) {
    if (left_ == kNone) return;
    if (force == 0) {
      left_ = kNone;
    } else if (left_ == kNew) {
      left_ = 3 + static_cast<int>(1.2 * std::numbers::pi * std::sqrt(m / K) / T);
    } else {
      left_ += left_ > 0 ? -1 : 1;
    }
  }
  // Takes that the parts part. Without restitution the impact is over.
  void turn(double restitution) { left_ = restitution > 0 ? -left_ : kNone; }

  int number() const { return left_; }
  void read(double number) { left_ = static_cast<int>(number); }

 private:
  static constexpr int kNone = 0, kNew = 1 << 20;
  int left_ = kNone;  // ticks that it may last; negative after the turn
  double approach_ = 0;
};

}  // namespace limpid
