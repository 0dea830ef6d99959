#include "app/experiments/moving.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/dynamics/arm.h"

namespace limpid {

std::string scene_of(const std::vector<BoxText>& boxes, const std::string& before) {
  std::string text = "title = \"Bodies\"\nabout = \"What moves.\"\n" + before;
  for (const BoxText& box : boxes) {
    text += fmt::format(
        "\n[[body]]\nname = \"{}\"\nbox = [{:.9g}, {:.9g}, {:.9g}]\nmass = {:.9g}\n"
        "position = [{:.9g}, {:.9g}, {:.9g}]\nstiffness = {:.9g}\n"
        "friction_static = {:.9g}\nfriction_kinetic = {:.9g}\n{}",
        box.name, box.size.x(), box.size.y(), box.size.z(), box.mass, box.at.x(), box.at.y(),
        box.at.z(), box.stiffness, box.friction, box.friction, box.more);
  }
  return text;
}

double beyond_at(const Session& session, std::size_t k) {
  return session.at(k, Column::energy_port)[0] + session.at(k, Column::energy_to_objects)[0];
}

MovingVerdict judge_moving(const TrialResult& result) {
  constexpr double kLost = std::numeric_limits<double>::infinity();
  if (result.end.diverged) return {kLost, kLost, kLost, -kLost, 0, 0, 0};
  const Session& s = result.session;
  MovingVerdict v;
  const double at_first = s.at(0, Column::energy_ledger)[0];
  for (std::size_t k = 0; k < s.size(); ++k) {
    v.energy = worse(v.energy, s.at(k, Column::energy_total)[0]);
    v.beyond = worse(v.beyond, beyond_at(s, k));
    v.gain = worse(v.gain, s.at(k, Column::objects_gain)[0]);
    v.reserve = worse_low(v.reserve, s.at(k, Column::energy_ledger)[0] - at_first);
    v.governor = worse_low(v.governor, s.at(k, Column::governor)[0]);
    v.sweeps = worse(v.sweeps, s.at(k, Column::objects_sweeps)[0]);
    if (s.at(k, Column::solved)[0] == 3) ++v.unsolved;
  }
  return v;
}

TipRecord tip_record(const ArmDescription& description, const Session& s) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames frames;
  Jacobian<kAnyDof> J;
  TipRecord record{s.info.tick, {}, {}};
  for (std::size_t k = 0; k < s.size(); ++k) {
    const Eigen::VectorXd x = vector_at(s, k, Column::device_position);
    record.tip.push_back(arm.tip_at(x));
    if (k + 1 == s.size()) break;
    arm.frames((x + vector_at(s, k + 1, Column::device_position)) / 2, frames);
    arm.point_jacobian(frames, arm.dof() - 1, arm.tip(frames), J);
    const Mat3 to_joints = J.transpose();
    record.force.emplace_back(to_joints.lu().solve(Vec3(vector_at(s, k, Column::hand_torque))));
  }
  return record;
}

double felt_mass(const TipRecord& record, std::size_t from, double f) {
  std::complex<double> power = 0;
  double speed2 = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> force, speed;
    for (std::size_t k = from; k < record.force.size(); ++k) {
      force.push_back(record.force[k][axis]);
      speed.push_back((record.tip[k + 1] - record.tip[k])[axis] / record.tick);
    }
    const std::complex<double> v = amplitude_at(speed, record.tick, f);
    power += std::conj(v) * amplitude_at(force, record.tick, f);
    speed2 += std::norm(v);
  }
  return power.imag() / (2 * std::numbers::pi * f * speed2);
}

bool dies_away(const std::vector<double>& speeds) {
  const std::size_t fifth = speeds.size() / 5;
  const auto fastest = [&](std::size_t from) {
    double speed = 0;
    for (std::size_t k = from; k < from + fifth; ++k) speed = worse(speed, speeds[k]);
    return speed;
  };
  return fifth > 0 && fastest(4 * fifth) < fastest(fifth);
}

}  // namespace limpid
