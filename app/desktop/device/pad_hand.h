// Hand led by a gamepad: the left stick moves it in the plane of the picture, triggers or the right
// stick nearer and farther.
#pragma once

#include <string>

#include "app/live/live_loop.h"
#include "core/dynamics/arm_description.h"
#include "core/dynamics/inverse_kinematics.h"

namespace limpid {

// Returns the point, or the nearest point to it within the arm's reach.
inline Vec3 within_reach(const ArmDescription& arm, const Vec3& point) {
  const Vec3 base = arm.joints.front().origin.translation();
  const double limit = 0.985 * reach(arm);
  const Vec3 out = point - base;
  return out.norm() > limit ? Vec3(base + out.normalized() * limit) : point;
}

// Reading of a gamepad: sticks -1 to 1, right and down; triggers 0 to 1; buttons as on an Xbox pad.
struct PadReading {
  double left_x = 0, left_y = 0, right_y = 0;
  double left_trigger = 0, right_trigger = 0;
  bool a = false, b = false, x = false, y = false;
};

// Gamepad that is plugged in.
struct Pad {
  std::string id, name;  // id: the same whenever it is plugged in; name: for people
  PadReading now;
};

// Returns the push as part of the full speed: right, up and away in the picture. It is zero while
// the sticks rest, which they never do exactly, and small near their rest for fine motion.
Vec3 pad_push(const PadReading& pad);

// Unit vectors of the picture's directions.
struct PictureAxes {
  Vec3 right, up, away;
};

class PadHand {
 public:
  struct Asked {
    bool cut = false, next_law = false, magnet = false;
  };
  // Leads the hand of the arm with its tip at `tip` [m] for `dt` [s]. A push takes hold. A takes
  // hold or lets go, B asks for no force, Y for the next law, X for the magnet. After A has let go,
  // the sticks have to rest before they take hold again.
  Asked lead(const PadReading& now, const PictureAxes& axes, const ArmDescription& arm,
             const Vec3& tip, double dt, Controls& controls);
  // Notes that the gamepad is gone: lets go if it held.
  void lose(Controls& controls);

 private:
  void take_hold(const Vec3& tip, Controls& controls);

  PadReading before_;
  bool rested_ = true, holds_ = false;
};

}  // namespace limpid
