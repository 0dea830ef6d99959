// Orientation of the tool in the hand, from a maker's axes to Limpid's.
#pragma once

#include <array>

#include "core/math/sizes.h"

namespace limpid {

// Turns a maker's rotation matrix into Limpid's quaternion w x y z, which is 1 0 0 0 for a tool
// that points forward, its upper side up. The rows of `axes` are Limpid's axes, forward, left and
// up, in the maker's; the tool has the same axes as the maker's frame where its matrix is the unit
// matrix. All zero if the matrix is no rotation.
std::array<float, 4> tool_orientation(const Mat3& axes, const Mat3& turned);

}  // namespace limpid
