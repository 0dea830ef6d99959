// Exchange between the haptic thread and a HID device of any kind: readings come in, torques go
// out, and any failure ends in no torque.
//
// The torque sent is zero unless all of this holds: a tick asked for the torque at most kTorqueLife
// ago; the newest reading is younger than the protocol allows; the device reports no fault and the
// hand on it; every number is finite.
//
// A protocol may send several reports for a torque, and an endpoint may take some milliseconds for
// each. All conditions are therefore checked before each report. If they hold no more, or the loop
// wants no torque by then, the rest is dropped, and zero is sent at once.
//
// A lapse is a torque that was withheld, or came to a device that had heard nothing for a while.
// The force is gone then, and must not come back in one report. Torques count again once the loop
// has read of the lapse, which makes it start from zero.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <span>

#include "core/realtime/triple_buffer.h"
#include "devices/device.h"
#include "devices/hid/hid_protocol.h"

namespace limpid {

// Reads CLOCK_MONOTONIC, or simulates it; both threads call it. It must neither wait nor allocate.
using ReadClock = std::function<nanoseconds()>;

// Exchange with one device. read, write and stop belong to the haptic thread; step and finish to
// the I/O thread.
class HidExchange {
 public:
  // Longest life of a command's torque; less than 10 ms with the turn that notices its end.
  static constexpr nanoseconds kTorqueLife = std::chrono::milliseconds(7);
  static constexpr nanoseconds kSendPeriod = std::chrono::milliseconds(1);
  // Longest silence towards the device: it drops its force by itself after 10 ms, and a PID effect
  // may be 4 ms old already.
  static constexpr nanoseconds kSendGap = std::chrono::milliseconds(5);
  static constexpr nanoseconds kAskAfter = std::chrono::milliseconds(2);
  static constexpr int kMostFailures = 10;  // failed writes in a row; then the device is lost

  // `protocol` must have been opened. Keeps references to both; they must outlive it.
  HidExchange(HidTransport& transport, HidProtocol& protocol, ReadClock clock);

  bool read(DeviceReading& newest) noexcept;
  void write(std::span<const double> torque) noexcept;
  void stop() noexcept;

  // Does one turn: takes the reports that came, waiting for them up to a millisecond, and sends the
  // torque due now. False once the device is lost.
  bool step() noexcept;
  // Takes all force away for good; true if the device received that.
  bool finish() noexcept;

  bool lost() const noexcept { return lost_.load(std::memory_order_relaxed); }
  // Number of reports that were damaged or made no sense.
  std::uint64_t unusable() const noexcept { return unusable_.load(std::memory_order_relaxed); }

 private:
  using Torque = std::array<double, kMaxDof>;
  struct Command {
    Torque torque{};
    nanoseconds moment{};
    std::uint32_t lapses = 0;  // lapses that the loop knew of
    bool any = false;          // a command was given
  };
  struct Arrival {
    DeviceReading reading;
    nanoseconds moment{};
  };

  void receive(int timeout_ms) noexcept;
  void take_reading(const DeviceReading& reading) noexcept;
  void ask_if_silent() noexcept;
  void send() noexcept;
  bool may_push(nanoseconds now) const noexcept;
  bool wants_torque() const noexcept;
  Torque torque_now(nanoseconds now) noexcept;
  Torque withheld() noexcept;
  void deliver_if_due(std::span<const std::uint8_t> report) noexcept;
  bool deliver(std::span<const std::uint8_t> report) noexcept;
  void lose() noexcept { lost_.store(true, std::memory_order_relaxed); }

  HidTransport& transport_;
  HidProtocol& protocol_;
  ReadClock clock_;
  std::size_t dof_;

  std::uint32_t known_lapses_ = 0;  // lapses that the haptic thread knows of
  TripleBuffer<Command> commands_;
  TripleBuffer<Arrival> arrivals_;
  std::atomic<bool> lost_{false};
  std::atomic<std::uint64_t> unusable_{0};

  // Members of the I/O thread.
  std::array<std::uint8_t, HidTransport::kMaxMessage> buffer_{};
  Arrival arrival_;
  SendReport deliver_, deliver_if_due_;
  bool news_ = false;       // a command has come since the last torque was sent
  bool overtaken_ = false;  // the torque being sent must not be sent any more
  nanoseconds sent_{};
  nanoseconds heard_{};    // last time that the device got a report
  nanoseconds went_on_{};  // in send(): moves on from report to report, up to a stall
  bool sent_any_ = false;
  int failures_ = 0;
  nanoseconds asked_{};
};

}  // namespace limpid
