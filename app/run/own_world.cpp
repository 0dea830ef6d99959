#include "app/run/own_world.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/base/folders.h"
#include "core/dynamics/arm.h"
#include "core/dynamics/inverse_kinematics.h"
#include "core/math/elementary.h"
#include "devices/files/session/hand_file.h"

namespace limpid {
namespace {

constexpr double kLongest = 8;  // [s]
constexpr double kStep = 0.01;  // between two points [s]
constexpr double kPart = 0.05;  // of the reach
constexpr double kDesk = 0.6;   // reach of what stands on a desk [m]

}  // namespace

bool suits_default_world(const ArmDescription& arm) {
  const HandPath path = read_hand(default_hand());
  const Vec3 base = arm.joints.front().origin.translation();
  double farthest = 0;
  for (const Vec3& point : path.position) farthest = std::max(farthest, (point - base).norm());
  const double most = reach(arm);
  return farthest <= most && most <= kDesk &&
         inverse_kinematics(arm, path.position.front(), rest_pose(arm)).has_value();
}

std::filesystem::path default_scene(const ArmDescription& arm) {
  if (suits_default_world(arm)) return default_scene();
  return data_dir() / "assets/scenes/free.toml";
}

std::filesystem::path scene_of_device(const ArmDescription& arm) {
  return arm.dof() == 2 ? data_dir() / "assets/devices/joystick.toml" : default_scene(arm);
}

SmallPath small_path(const ArmDescription& description) {
  const Arm<kAnyDof> arm(description);
  const Eigen::VectorXd rest = rest_pose(description);
  const Eigen::Index n = rest.size();
  // Each joint swings at a rate of its own, from rest to rest; the factor `swing` keeps the tip
  // near.
  const auto pose = [&](double swing, double t) {
    const double wave = sine(std::numbers::pi * t / kLongest), gate = wave * wave;
    Eigen::VectorXd x = rest;
    for (Eigen::Index i = 0; i < n; ++i) {
      const Joint& joint = description.joints[static_cast<std::size_t>(i)];
      const double rate = 2 * std::numbers::pi * (1 + static_cast<double>(i % 3)) / 4;
      const double room = 0.9 * std::min(rest[i] - joint.lower, joint.upper - rest[i]);
      x[i] += std::clamp(swing * gate * sine(rate * t + static_cast<double>(i)), -room, room);
    }
    return Vec<kAnyDof>(x);
  };
  const auto path = [&](double swing) {
    std::vector<Vec3> points;
    for (double t = 0; t <= kLongest + kStep / 2; t += kStep) {
      points.push_back(arm.tip_at(pose(swing, t)));
    }
    return points;
  };
  const double wanted = kPart * reach(description);
  const auto widest = [](const std::vector<Vec3>& points) {
    double most = 0;
    for (const Vec3& point : points) most = std::max(most, (point - points.front()).norm());
    return most;
  };
  double swing = 0.5;
  for (int i = 0; i < 20 && widest(path(swing)) > wanted; ++i) swing *= 0.8;
  std::vector<Vec3> points = path(swing);
  std::vector<double> times;
  for (std::size_t i = 0; i < points.size(); ++i) times.push_back(kStep * static_cast<double>(i));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
  const Vec3 first = points.front();
  return {hand_through(std::move(times), std::move(points), "a small path within reach"),
          {rest, zero, rest, zero, zero, first, true}};
}

}  // namespace limpid
