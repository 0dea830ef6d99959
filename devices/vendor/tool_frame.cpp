#include "devices/vendor/tool_frame.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace limpid {
namespace {

constexpr double kNoRotation = 0.02;  // of the elements of R^T R that are off the unit matrix's

}  // namespace

std::array<float, 4> tool_orientation(const Mat3& axes, const Mat3& turned) {
  const Mat3 off = turned.transpose() * turned - Mat3::Identity();
  if (!(off.cwiseAbs().maxCoeff() <= kNoRotation) || !(turned.determinant() > 0)) return {};
  const Mat3 ours = axes * turned * axes.transpose();
  const Eigen::Quaternionf q = Eigen::Quaterniond(ours).normalized().cast<float>();
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace limpid
