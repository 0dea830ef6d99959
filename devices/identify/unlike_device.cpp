#include "devices/identify/unlike_device.h"

#include <cmath>
#include <random>

namespace limpid {
namespace {

// The same with every standard library.
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

UnlikeDevice::UnlikeDevice(const ArmDescription& truth, const Unlikeness& unlike)
    : unlike_(unlike), arm_(truth), device_(truth), traits_(device_.traits()) {
  parameters_of_links_ = parameters_of(truth);
  traits_.name = "a device unlike its file";
  traits_.guarded = true;
  others_ = push = Eigen::VectorXd::Zero(truth.dof());
  parameters_.encoder_step = unlike.encoder_step;
  parameters_.device_delay = unlike.delay;
  hand_.grip = 0;
  device_.expect(parameters_, hand_);
  const Eigen::VectorXd x = rest_pose(truth);
  device_.place(span_of(x), span_of(others_), arm_.tip_at(x));
}

void UnlikeDevice::write(std::span<const double> torque) noexcept {
  const Vec<kAnyDof> x = device_.arm.x(), zero = Vec<kAnyDof>::Zero(x.size());
  others_ = push - regressor(arm_, x, zero, zero, unlike_.gravity) * parameters_of_links_;
  if (unlike_.spring.size() > 0) others_ -= unlike_.spring.cwiseProduct(x);
  if (unlike_.offset.size() > 0) others_ -= unlike_.offset;
  hand_.torque = span_of(others_);
  device_.expect(parameters_, hand_);
  device_.write(torque);
}

}  // namespace limpid
