#include "devices/identify/unlike_device.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace limpid {
namespace {

// Random numbers that are the same with every standard library.
class Drawn {
 public:
  explicit Drawn(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967295.0;
  }

 private:
  std::mt19937 engine_;
};

std::span<const double> span_of(const Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

ArmDescription with(ArmDescription arm, const Unlikeness& unlike) {
  arm.gravity = unlike.gravity;
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    arm.joints[i].spring = unlike.spring.size() > 0 ? unlike.spring[k] : 0;
    arm.joints[i].offset = unlike.offset.size() > 0 ? unlike.offset[k] : 0;
  }
  return arm;
}

}  // namespace

ArmDescription unlike(const ArmDescription& file, unsigned seed, double most_friction) {
  Drawn drawn(seed);
  ArmDescription arm = file;
  for (Link& link : arm.links) {
    const double factor = std::exp2(drawn.between(-1, 1));
    link.mass *= factor;
    link.inertia *= factor;
    for (double& c : link.com) c += drawn.between(-0.005, 0.005);
  }
  for (Joint& joint : arm.joints) {
    joint.damping = drawn.between(0.002, 0.02);
    joint.friction = drawn.between(0, most_friction);
  }
  return arm;
}

Unlikeness drawn_bench(const ArmDescription& file, unsigned seed, const Vec3& gravity) {
  constexpr double kTurn = 2 * 3.14159265358979323846;
  Drawn drawn(seed + 1000003);  // other numbers than unlike() draws
  const double cells = drawn.between(0, 1) < 0.5 ? 1 << 10 : 1 << 16;
  double widest = 0;
  for (const Joint& joint : file.joints) {
    const double range = joint.upper - joint.lower;
    widest = std::max(widest, std::isfinite(range) ? range : kTurn);
  }
  Unlikeness bench{.gravity = gravity, .encoder_step = widest / cells};
  bench.delay = 1 + static_cast<int>(drawn.between(0, 3.999));
  bench.spring = bench.offset = Eigen::VectorXd::Zero(file.dof());
  for (double& spring : bench.spring) spring = drawn.between(0, 0.1);
  for (double& offset : bench.offset) offset = drawn.between(-0.02, 0.02);
  return bench;
}

double drawn_torque_scale(unsigned seed) {
  return std::exp2(Drawn(seed + 2000003).between(-0.5, 0.5));
}

ArmDescription loaded(ArmDescription arm, double mass) {
  const Link load{.name = "load", .mass = mass, .com = arm.tip.translation()};
  set_parameters(arm.links.back(), parameters_of(arm.links.back()) + parameters_of(load));
  return arm;
}

UnlikeDevice::UnlikeDevice(const ArmDescription& truth, const Unlikeness& unlike)
    : device_(with(truth, unlike)), traits_(device_.traits()) {
  traits_.name = "a device unlike its file";
  traits_.guarded = true;
  push = Eigen::VectorXd::Zero(truth.dof());
  parameters_.encoder_step = unlike.encoder_step;
  parameters_.device_delay = unlike.delay;
  parameters_.torque_scale = unlike.torque_scale;
  parameters_.weighs = parameters_.springy = true;
  hand_.grip = 0;
  put(rest_pose(truth));
}

void UnlikeDevice::put(const Eigen::VectorXd& x) {
  const Eigen::VectorXd v = Eigen::VectorXd::Zero(x.size());
  device_.expect(parameters_, hand_);
  device_.place(span_of(x), span_of(v), Vec3::Zero());
  device_.place(span_of(x), span_of(v), device_.arm.tip());
}

void UnlikeDevice::expect(const Parameters& p, const HandInput& hand) noexcept {
  parameters_.hand_stiffness = p.hand_stiffness;
  parameters_.hand_damping = p.hand_damping;
  parameters_.hand_mass_at_tip = p.hand_mass_at_tip;
  hand_.target = hand.target;
  hand_.grip = hand.grip;
}

void UnlikeDevice::write(std::span<const double> torque) noexcept {
  hand_.torque = span_of(push);
  device_.expect(parameters_, hand_);
  device_.write(torque);
}

}  // namespace limpid
