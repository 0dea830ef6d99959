#include "app/desktop/device/pad_hand.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limpid {

namespace {

constexpr double kRest = 0.15;         // part of a stick's way: a worn stick rests that far off
constexpr double kTriggerRest = 0.05;  // part of a trigger's way
constexpr double kFastest = 0.25;      // speed of the hand [m/s]
constexpr double kFarthest = 0.10;  // distance of the hand from the tip, which may be blocked [m]

double beyond(double way, double rest) {
  const double part = std::clamp((std::abs(way) - rest) / (1 - rest), 0.0, 1.0);
  return std::copysign(part * part, way);
}

}  // namespace

Vec3 pad_push(const PadReading& pad) {
  const double way = std::hypot(pad.left_x, pad.left_y), part = beyond(way, kRest);
  const double away = beyond(pad.right_trigger, kTriggerRest) -
                      beyond(pad.left_trigger, kTriggerRest) - beyond(pad.right_y, kRest);
  const double scale = way > 0 ? part / way : 0;
  return {scale * pad.left_x, -scale * pad.left_y, std::clamp(away, -1.0, 1.0)};
}

void PadHand::take_hold(const Vec3& tip, Controls& controls) {
  controls.grab = holds_ = true;
  controls.goal = tip;
}

PadHand::Asked PadHand::lead(const PadReading& now, const PictureAxes& axes,
                             const ArmDescription& arm, const Vec3& tip, double dt,
                             Controls& controls) {
  const PadReading before = std::exchange(before_, now);
  const Vec3 push = pad_push(now);
  const bool pushes = !push.isZero(0);
  holds_ = holds_ && controls.grab;  // the mouse, say, may have let go
  if (now.a && !before.a) {
    if (controls.grab) {
      controls.grab = holds_ = rested_ = false;
    } else {
      take_hold(tip, controls);
    }
  }
  if (!pushes) rested_ = true;
  if (pushes && rested_ && !controls.grab) take_hold(tip, controls);
  if (pushes && controls.grab) {
    const Vec3 way = push.x() * axes.right + push.y() * axes.up + push.z() * axes.away;
    const Vec3 off = controls.goal + kFastest * dt * way - tip;
    const double stretch = std::max(1.0, off.norm() / kFarthest);
    controls.goal = within_reach(arm, tip + off / stretch);
    holds_ = true;
  }
  return {.cut = now.b && !before.b, .next_law = now.y && !before.y, .magnet = now.x && !before.x};
}

void PadHand::lose(Controls& controls) {
  if (holds_) controls.grab = false;
  *this = PadHand();
}

}  // namespace limpid
