// Vectors and matrices of n joints, without allocation.
//
// A number of joints known when compiling (N = 3, the haptic devices people own) costs nothing
// extra; any other n up to kMaxDof runs the same code on storage of bounded size.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace limpid {

inline constexpr int kMaxDof = 32;
inline constexpr int kAnyDof = Eigen::Dynamic;

template <int N>
inline constexpr int kCapacity = N == kAnyDof ? kMaxDof : N;

template <int N>
using Vec = Eigen::Matrix<double, N, 1, 0, kCapacity<N>, 1>;
template <int N>
using Mat = Eigen::Matrix<double, N, N, 0, kCapacity<N>, kCapacity<N>>;
template <int N>
using Jacobian = Eigen::Matrix<double, 3, N, 0, 3, kCapacity<N>>;  // rows x, y, z

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Pose = Eigen::Isometry3d;

}  // namespace limpid
