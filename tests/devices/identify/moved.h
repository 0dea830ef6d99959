// The motion by which a simulated device is identified.
#pragma once

#include <vector>

#include "devices/identify/excitation.h"
#include "devices/identify/motion_record.h"

namespace limpid::test {

// Runs `motion` to its end; the caller may inspect it.
inline MotionRecord moved(Device& device, Excitation& motion) {
  const Eigen::Index n = device.traits().dof;
  MotionRecord record;
  std::vector<Eigen::VectorXd> x, torque;
  while (motion.end() == ExcitationEnd::running) {
    DeviceReading reading;
    device.read(reading);
    const auto at = std::span(reading.x).first(static_cast<std::size_t>(n));
    const auto sent = motion.step({at, 0.001, {.guarded = true}});
    x.emplace_back(Eigen::Map<const Eigen::VectorXd>(at.data(), n));
    torque.emplace_back(Eigen::Map<const Eigen::VectorXd>(sent.data(), n));
    device.write(sent);
  }
  record.x.resize(static_cast<Eigen::Index>(x.size()), n);
  record.torque.resizeLike(record.x);
  for (Eigen::Index i = 0; i < record.rows(); ++i) {
    record.x.row(i) = x[static_cast<std::size_t>(i)];
    record.torque.row(i) = torque[static_cast<std::size_t>(i)];
  }
  return record;
}

inline MotionRecord moved(Device& device, const ArmDescription& file) {
  Excitation motion(file, device.traits(), {});
  return moved(device, motion);
}

}  // namespace limpid::test
