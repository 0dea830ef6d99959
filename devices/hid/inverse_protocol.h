// The Inverse3 of Haply Robotics by way of its maker's local service, the Haply Inverse Service:
// the position of the cursor comes in, a force on it goes out.
//
// The JSON format of its simulation channel, ws://localhost:10001, as services 3.1 to 3.5 speak it
// (docs.haply.co/inverseSDK/service/realtime/websocket-protocol, .../api/simulation and
// .../commons/json-conventions): on connecting it lists all devices with config, state and status;
// then it answers every message with one that has state and status of all. A force is
// {"inverse3": [{"device_id": ID, "commands": {"set_cursor_force": {"values": {x, y, z}}}}]} [N];
// 3.5 writes "vector" where it had "values", and takes both.
//
// A force is "applied once and forgotten": when none follows "the device returns to idle". After
// how long is not said, so nothing here relies on it. As nothing is answered unasked, the device
// paces what is said: at most one command waits for its answer, so that no force can queue up
// behind a slow service and come late; only the zero that follows a force goes out regardless.
//
// Coordinates: joint i is the cursor's x, y or z in slide units (kSlideUnit), as the service has
// it at first: x to the right, y away from the user, z up, from the middle of the mounting plate.
// A service that was told to scale or turn them is refused; one that is told so later is at fault
// from the message on that says it.
#pragma once

#include <array>
#include <bitset>
#include <string>

#include "devices/hid/hid_protocol.h"

namespace limpid {

// The devices in a message of the service's, by their ids; empty if it makes no sense.
std::vector<std::string> inverse_ids(std::span<const std::uint8_t> report);

class InverseProtocol final : public HidProtocol {
 public:
  static constexpr int kFirstMessage = 500;  // longest wait for the list of devices [ms]
  static constexpr double kFarthest = 1;     // a cursor farther away is none [m]
  // It cannot have moved further than this since it was last seen.
  static constexpr double kLeap = 0.01;   // [m] and
  static constexpr double kFastest = 10;  // [m/s]
  // After so much silence another command is sent, in case the answer was lost.
  static constexpr nanoseconds kAskAgain = std::chrono::milliseconds(100);

  // A zero that did not leave is sent again after this.
  static constexpr nanoseconds kZeroAgain = std::chrono::milliseconds(1);

  // Of the device with this id; empty: of the first that there is.
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

  std::string id_;
  DeviceTraits traits_;
  std::vector<Report> stop_reports_;
  nanoseconds now_{}, asked_{}, seen_{};
  int unanswered_ = 0;
  bool pushing_ = false;    // the newest command was a force
  bool zero_lost_ = false;  // or it was no force, and did not leave
  bool seen_any_ = false;
  bool fault_ = false;
  std::bitset<4> other_frame_;      // than its own: basis, preset, mount, workspace
  std::array<double, 3> cursor_{};  // where it was last seen [m]
};

}  // namespace limpid
