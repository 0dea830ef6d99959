// Vectors and matrices of n joints, without allocation.
//
// A number of joints known when compiling costs nothing extra: N = 3, the haptic devices people
// own, and 7, the robot arms beside them. Any other n up to kMaxDof runs the same code on storage
// of bounded size.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <type_traits>

namespace limpid {

inline constexpr int kMaxDof = 32;
inline constexpr int kAnyDof = Eigen::Dynamic;

// Calls f(N) with a constant N: dof where code is compiled for that number, else kAnyDof.
template <class F>
decltype(auto) with_dof(int dof, F&& f) {
  switch (dof) {
    case 3: return f(std::integral_constant<int, 3>{});
    case 7: return f(std::integral_constant<int, 7>{});
    default: return f(std::integral_constant<int, kAnyDof>{});
  }
}

template <int N>
inline constexpr int kCapacity = N == kAnyDof ? kMaxDof : N;

template <int N>
using Vec = Eigen::Matrix<double, N, 1, 0, kCapacity<N>, 1>;
template <int N>
using Mat = Eigen::Matrix<double, N, N, 0, kCapacity<N>, kCapacity<N>>;
template <int N>
using Jacobian = Eigen::Matrix<double, 3, N, 0, 3, kCapacity<N>>;  // rows x, y, z
template <int N>
using Levers = Eigen::Matrix<double, N, 3, 0, kCapacity<N>, 3>;  // a Jacobian's transpose

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Pose = Eigen::Isometry3d;

}  // namespace limpid
