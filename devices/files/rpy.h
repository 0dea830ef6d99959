// Rotations as files say them: roll, pitch, yaw about the fixed axes x, y, z, as in URDF [rad].
#pragma once

#include "core/math/sizes.h"

namespace limpid {

Mat3 rotation(const Vec3& rpy);
Eigen::Quaterniond turn(const Vec3& rpy);
Eigen::Quaterniond turn(double angle, const Vec3& axis);  // about a unit axis

// Angles with rotation(rpy_of(R)) == R if there are simple ones, of at most nine decimals; others
// mostly so, else to round-off.
Vec3 rpy_of(const Mat3& R);

// R, or the rotation next to it, to 1e-9 rad, that rpy_of() gives back to the last bit.
Mat3 settled(const Mat3& R);

}  // namespace limpid
