// Device of a program that brings its own: its readings are handed in, its torques taken out.
#pragma once

#include "core/dynamics/arm_description.h"
#include "devices/device.h"

namespace limpid {

// Numbers of the outside are in SI units, those of slides in metres and newtons.
class CallerDevice final : public Device {
 public:
  CallerDevice(const ArmDescription& arm, bool guarded);

  // Whether a reading tells each joint's position. After the first, nothing is looked at of one
  // that is not fresh.
  bool whole(std::span<const double> position, bool fresh) const noexcept {
    return repeated(fresh) || position.size() == unit_.size();
  }
  // Takes a reading in, of positions [rad or m]; `elapsed`: time since the one before [s].
  void take(std::span<const double> position, bool fresh, bool hand, bool fault,
            double elapsed) noexcept;
  std::span<const double> torque() const { return torque_; }  // [N m or N]

  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override;
  void write(std::span<const double> torque) noexcept override;
  void stop() noexcept override;

 private:
  bool repeated(bool fresh) const noexcept { return !fresh && reading_.count > 0; }

  DeviceTraits traits_;
  std::vector<double> unit_;    // of each joint's coordinate [rad or m]
  std::vector<double> torque_;  // [N m or N]
  DeviceReading reading_;
  bool whole_ = true;  // the newest reading had a number for each joint
};

}  // namespace limpid
