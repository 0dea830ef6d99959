// Rotations in files: roll, pitch, yaw about the fixed axes x, y, z, as in URDF [rad].
#pragma once

#include "core/math/sizes.h"

namespace limpid {

Mat3 rotation(const Vec3& rpy);
Eigen::Quaterniond turn(const Vec3& rpy);
Eigen::Quaterniond turn(double angle, const Vec3& axis);  // about a unit axis

// Angles of R, of at most nine decimals where such give R exactly. Others mostly give R to the last
// bit, else to round-off.
Vec3 rpy_of(const Mat3& R);

// R, or a rotation within 1e-9 rad of it, that rotation(rpy_of()) gives back to the last bit.
Mat3 settled(const Mat3& R);

}  // namespace limpid
