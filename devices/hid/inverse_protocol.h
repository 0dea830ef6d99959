// Protocol of Haply Robotics' Inverse3, by its maker's local service, the Haply Inverse Service.
// The position of the cursor comes in, a force on it goes out.
//
// It is the JSON format of the service's simulation channel, ws://localhost:10001, in versions 3.1
// to 3.5 (docs.haply.co/inverseSDK/service/realtime/websocket-protocol, .../api/simulation and
// .../commons/json-conventions). On connecting the service lists all devices with config, state and
// status; then it answers every message with one that has state and status of all. A force is
// {"inverse3": [{"device_id": ID, "commands": {"set_cursor_force": {"values": {x, y, z}}}}]} [N];
// 3.5 writes "vector" for "values", and takes both.
//
// A force is "applied once and forgotten": when none follows "the device returns to idle". The time
// until then is not documented, so nothing here relies on it. The service sends only answers, so
// the device paces the exchange. At most one command waits for its answer: no force can queue up
// behind a slow service and come late. Only the zero that follows a force goes out regardless.
//
// Coordinates: joint i is the cursor's x, y or z in slide units (kSlideUnit), in the service's
// initial frame: x to the right, y away from the user, z up, from the middle of the mounting plate.
// A service that was told to scale or turn them is refused. One that is told so later is at fault
// from the message on that says it.
#pragma once

#include <array>
#include <bitset>
#include <string>

#include "devices/hid/hid_protocol.h"

namespace limpid {

// Ids of the devices in a message of the service; empty if the message makes no sense.
std::vector<std::string> inverse_ids(std::span<const std::uint8_t> report);

class InverseProtocol final : public HidProtocol {
 public:
  static constexpr int kFirstMessage = 500;  // longest wait for the list of devices [ms]
  static constexpr double kFarthest = 1;     // a cursor farther away is none [m]
  // A cursor cannot have moved farther than this since it was last seen.
  static constexpr double kLeap = 0.01;   // [m] and
  static constexpr double kFastest = 10;  // [m/s]
  // Silence after which another command is sent, in case the answer was lost.
  static constexpr nanoseconds kAskAgain = std::chrono::milliseconds(100);

  // Time after which a zero that did not leave is sent again.
  static constexpr nanoseconds kZeroAgain = std::chrono::milliseconds(1);

  // Drives the device with this id; empty: the first one.
  explicit InverseProtocol(std::string id) : id_(std::move(id)) {}

  void open(HidTransport& transport) override;
  const DeviceTraits& traits() const override { return traits_; }
  nanoseconds stale_after() const override { return std::chrono::milliseconds(5); }
  Decoded decode(std::span<const std::uint8_t> report, DeviceReading& reading) noexcept override;
  void encode(std::span<const double> torque, nanoseconds now,
              const SendReport& send) noexcept override;
  void undelivered() noexcept override;
  const std::vector<Report>& stop_reports() const override { return stop_reports_; }

 private:
  Report command(const std::array<double, 3>& force) const;
  bool follows(const std::array<double, 3>& cursor);
  template <class Json>
  void follow_frame(const Json& config, const Json& workspace);
  template <class Json>
  void take_buttons(const Json& grips, DeviceReading& reading);

  std::string id_;
  std::string grip_;         // the grip whose buttons count; empty: none do
  bool seen_grips_ = false;  // in a message
  DeviceTraits traits_;
  std::vector<Report> stop_reports_;
  nanoseconds now_{}, asked_{}, seen_{};
  int unanswered_ = 0;
  bool pushing_ = false;    // the newest command was a force
  bool zero_lost_ = false;  // the newest command was zero, and did not leave
  bool seen_any_ = false;
  bool fault_ = false;
  std::bitset<4> other_frame_;      // not the device's own: basis, preset, mount, workspace
  std::array<double, 3> cursor_{};  // last seen position [m]
};

}  // namespace limpid
