// A hand led by a gamepad: the left stick moves it in the plane of the picture, triggers or the
// right stick nearer and farther.
#pragma once

#include <string>

#include "app/live/live_loop.h"
#include "core/dynamics/arm_description.h"
#include "core/dynamics/inverse_kinematics.h"

namespace limpid {

// Where a hand may be asked to go.

// Held where the arm can follow.
inline Vec3 within_reach(const ArmDescription& arm, const Vec3& point) {
  const Vec3 base = arm.joints.front().origin.translation();
  const double limit = 0.985 * reach(arm);
  const Vec3 out = point - base;
  return out.norm() > limit ? Vec3(base + out.normalized() * limit) : point;
}

// Sticks -1 to 1, right and down; triggers 0 to 1; buttons where an Xbox pad has them.
struct PadReading {
  double left_x = 0, left_y = 0, right_y = 0;
  double left_trigger = 0, right_trigger = 0;
  bool a = false, b = false, x = false, y = false;
};

// One that is plugged in.
struct Pad {
  std::string id, name;  // the same whenever it is plugged in; for people
  PadReading now;
};

// Which way, and which part of the full speed: right, up and away in the picture. Zero while the
// sticks rest, which they never do exactly; little near their rest, so that the hand is led finely.
Vec3 pad_push(const PadReading& pad);

// Unit vectors of the picture.
struct PictureAxes {
  Vec3 right, up, away;
};

class PadHand {
 public:
  struct Asked {
    bool cut = false, next_law = false, magnet = false;
  };
  // After `dt` [s]: leads the hand on the arm, whose tip is there [m]. A push takes hold, A takes
  // hold and lets go, B asks for no force, Y for the next law, X for the magnet. After A has let go
  // the sticks have to rest before they take hold again.
  Asked lead(const PadReading& now, const PictureAxes& axes, const ArmDescription& arm,
             const Vec3& tip, double dt, Controls& controls);
  // It is gone: lets go if it held.
  void lose(Controls& controls);

 private:
  void take_hold(const Vec3& tip, Controls& controls);

  PadReading before_;
  bool rested_ = true, holds_ = false;
};

}  // namespace limpid
