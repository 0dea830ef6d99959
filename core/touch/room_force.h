// Force of a room of planes over a whole tick.
#pragma once

#include "core/touch/free_space.h"
#include "core/touch/wall_force.h"

namespace limpid {

// The force is conservative like a single wall's. A spring K and damper B pull a ball's centre to
// the nearest free place. Over the tick the centre moves by D = a + W F: a without this force [m],
// W the response to it [m/N].
struct RoomTick {
  double K, B, T;
  Vec3 center;
  Vec3 a;
  Mat3 W;
};

// Computes the constant force F [N] = mean of -grad U over the segment from center to center + D.
// The damper's force in the held directions is subtracted. The mean of a gradient along a segment
// does exactly the work that the potential loses. `F`: in, a first guess; out, the force.
void room_force(const Room& room, const RoomTick& tick, Vec3& F);

// The force of room_force() for a known D = a, and its slope over D [N/m].
Vec3 room_push(const Room& room, const RoomTick& tick, Slope slope, Mat3& on_D);

}  // namespace limpid
