// The force of a mesh's room of planes over a whole tick, conservative like a single wall's.
#pragma once

#include "core/touch/mesh_touch.h"

namespace limpid {

// A spring K and damper B that pull the centre of a ball to the nearest place that a mesh leaves
// free, over a tick in which the centre moves by D = a + W F: a without this force [m], W what a
// force adds [m/N].
struct RoomTick {
  double K, B, T;
  Vec3 center;
  Vec3 a;
  Mat3 W;
};

// The constant force F [N] = mean of -grad U over the segment from center to center + D, minus the
// damper's in the directions that were held. The mean of a gradient along a segment does exactly
// the work that the potential loses. `F`: in, a first guess; out, the force.
void room_force(const MeshTouch& touch, const RoomTick& tick, Vec3& F);

// The same force where D = a is known, and how it answers D [N/m], while the damper's directions
// stand.
Vec3 room_push(const MeshTouch& touch, const RoomTick& tick, Mat3& on_D);

}  // namespace limpid
