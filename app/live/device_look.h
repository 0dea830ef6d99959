// A device that is only looked at: readings come through, torque never does, and what was seen is
// noted.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "core/realtime/latency.h"
#include "devices/device.h"
#include "devices/reading_watch.h"

namespace limpid {

// Noise of one joint's readings while it stands still: windows of a quarter of a second in which it
// stays within `still` and does not drift.
class RestNoise {
 public:
  static constexpr double kWindow = 0.25;  // [s]

  // Takes a position [rad] at `time` [s]; `still`: the most that noise alone moves it [rad].
  void add(double x, double time, double still) noexcept;
  // Returns the root mean square about each window's mean [rad]; nothing if it never stood still.
  std::optional<double> rms() const noexcept;
  double seconds() const noexcept { return kWindow * static_cast<double>(windows_); }

 private:
  void end_window(double still) noexcept;

  double began_ = 0, first_ = 0;  // of the window: its time [s], its first position [rad]
  double least_ = 0, most_ = 0;   // about first_ [rad]
  double squares_ = 0;            // about first_ [rad^2]
  std::array<double, 2> sum_{};   // of the window's halves, about first_ [rad]
  std::array<std::uint64_t, 2> count_{};
  bool open_ = false;
  double variance_ = 0;  // of all windows at rest [rad^2]
  std::uint64_t windows_ = 0;
};

struct JointSeen {
  double least = std::numeric_limits<double>::infinity();  // [rad]
  double most = -std::numeric_limits<double>::infinity();  // [rad]
  double step = std::numeric_limits<double>::infinity();   // smallest change seen [rad]
  RestNoise noise;
};

// All that the readings of a device have shown. Of several readings between two ticks only the
// newest is seen; all of them are counted.
class DeviceSeen {
 public:
  // Takes what read() has given at `now` [s].
  void take(const DeviceReading& reading, bool here, const DeviceTraits& traits,
            double now) noexcept;

  std::uint64_t readings() const { return count_; }
  // Readings a second; 0 of fewer than two.
  double rate() const {
    return last_ > first_ ? static_cast<double>(count_ - 1) / (last_ - first_) : 0;
  }
  double median_gap() const { return gaps_.quantile(0.5); }  // between two readings [s]
  double worst_gap() const { return worst_gap_; }            // [s]
  const JointSeen& joint(std::size_t i) const { return joints_[i]; }

  std::atomic<bool> noting{true};  // OnlyLooked passes on what it reads while this is set

  // How long the device said so [s].
  double without_hand = 0, fault = 0, uncalibrated = 0;
  std::array<double, kNoForces> no_force{};  // for each cause
  std::uint64_t unbelieved = 0;              // readings of what cannot be
  std::uint32_t buttons = 0;                 // a bit for each that was pressed
  float warmth = 0;                          // the most
  bool gone = false;                         // it was, at the end

 private:
  void take_state(const DeviceReading& reading, double dt) noexcept;
  void take_positions(const DeviceReading& reading, const DeviceTraits& traits,
                      double time) noexcept;

  LatencyHistogram gaps_;
  ReadingWatch watch_;
  std::array<JointSeen, kMaxDof> joints_;
  std::array<double, kMaxDof> before_{};  // positions [rad]
  std::uint64_t count_ = 0, newest_ = 0;  // readings since the first one; the device's own count
  double first_ = 0, last_ = 0;           // arrival of the first and the newest reading [s]
  double worst_gap_ = 0;                  // [s]
  double looked_at_ = 0;                  // time of the last take() [s]
};

// Passes on readings and nothing else. Neither torque nor stop reaches the device: its own thread
// then tells it that there is no torque.
class OnlyLooked final : public Device {
 public:
  OnlyLooked(std::unique_ptr<Device> device, std::shared_ptr<DeviceSeen> seen)
      : device_(std::move(device)), seen_(std::move(seen)) {}

  const DeviceTraits& traits() const override { return device_->traits(); }
  bool read(DeviceReading& newest) noexcept override;
  void write(std::span<const double>) noexcept override {}
  void stop() noexcept override {}

 private:
  std::unique_ptr<Device> device_;
  std::shared_ptr<DeviceSeen> seen_;
};

}  // namespace limpid
