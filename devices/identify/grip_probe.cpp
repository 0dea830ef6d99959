#include "devices/identify/grip_probe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/dynamics/arm.h"
#include "core/math/elementary.h"

namespace limpid {
namespace {

using std::numbers::pi;

constexpr double kUsual = 0.1;         // root mean square along an axis [N]
constexpr double kOverFriction = 2.4;  // part of the friction at the tip
// Share of a motor's torque limit whose root mean square it bears for hours, if that is not known.
constexpr double kBorne = 0.2;
constexpr double kCrest = 3;          // peak of the sum over its root mean square, at most
constexpr double kOfPeak = 0.75;      // share of a motor's torque limit for the peaks
constexpr double kChirp = 0.0328925;  // phases that keep the peaks of all three axes together low
constexpr int kAxes = 3;
constexpr double kOnEachAxis = static_cast<double>(GripProbe::kLines.size()) / kAxes;

}  // namespace

GripProbe::GripProbe(const ArmDescription& arm) {
  Arm<kAnyDof> model(arm);
  Arm<kAnyDof>::Frames frames;
  Jacobian<kAnyDof> J;
  model.frames(rest_pose(arm), frames);
  model.point_jacobian(frames, arm.dof() - 1, model.tip(frames), J);
  double friction = 0, most = 1e6;  // at the tip [N]
  for (int j = 0; j < arm.dof(); ++j) {
    const Joint& joint = arm.joints[static_cast<std::size_t>(j)];
    const double lever = J.col(j).norm();
    if (!(lever > 1e-9)) continue;
    friction = std::max(friction, joint.friction / lever);
    if (!(joint.effort > 0)) continue;
    const double borne = joint.continuous > 0 ? joint.continuous : kBorne * joint.effort;
    most = std::min({most, borne / lever, kOfPeak * joint.effort / (kCrest * lever)});
  }
  strength_ = std::min(std::max(kUsual, kOverFriction * friction), most);
}

int GripProbe::axis_of(int line) {
  const auto place = std::ranges::find(kLines, line) - kLines.begin();
  return static_cast<int>(place) % kAxes;
}

Vec3 GripProbe::at(double time) const {
  Vec3 force = Vec3::Zero();
  const double edge = std::min(time, kDuration - time) / kFade;
  if (!(edge > 0)) return force;
  for (const int line : kLines) {
    const double periods = line;
    const double phase = -pi * kChirp * periods * periods;
    force[axis_of(line)] += sine(2 * pi * periods * time / kMeasured + phase);
  }
  const double amplitude = strength_ * std::sqrt(2 / kOnEachAxis);
  return std::min(edge, 1.0) * amplitude * force;
}

}  // namespace limpid
