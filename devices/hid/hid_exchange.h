// What goes on between the haptic thread and a HID device, for every kind of device: readings come
// in, torques go out, and whatever fails ends in no torque.
//
// The torque sent is zero unless all of this holds: a tick asked for it at most kTorqueLife ago;
// the newest reading is younger than the protocol allows; the device reports no fault and the hand
// on it; every number is finite.
//
// A protocol may take several reports for a torque, and an endpoint some milliseconds for each: all
// of that is asked before each of them. Where it does not hold any more, or the loop asks for
// nothing by then, the rest is not sent, and zero is, at once.
//
// A torque that was withheld, or came to a device that had heard nothing for a while, is a lapse:
// the force is gone, and must not come back in one report. Torques count again once the loop has
// read of the lapse, which makes it start from zero.
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

// Reads CLOCK_MONOTONIC, or plays it; called by both threads, must neither wait nor allocate.
using ReadClock = std::function<nanoseconds()>;

// read, write and stop belong to the haptic thread; step and finish to the I/O thread.
class HidExchange {
 public:
  // With the turn in which it is noticed, less than 10 ms.
  static constexpr nanoseconds kTorqueLife = std::chrono::milliseconds(7);
  static constexpr nanoseconds kSendPeriod = std::chrono::milliseconds(1);
  // Devices drop their force by themselves after 10 ms; a PID effect may be 4 ms old already.
  static constexpr nanoseconds kSendGap = std::chrono::milliseconds(5);
  static constexpr nanoseconds kAskAfter = std::chrono::milliseconds(2);
  static constexpr int kMostFailures = 10;  // writes in a row; then the device is lost

  // The protocol must have been opened. Both must outlive this.
  HidExchange(HidTransport& transport, HidProtocol& protocol, ReadClock clock);

  bool read(DeviceReading& newest) noexcept;
  void write(std::span<const double> torque) noexcept;
  void stop() noexcept;

  // One turn: takes what came, waiting for it up to a millisecond; sends the torque due now. False
  // once the device is lost.
  bool step() noexcept;
  // Takes all force away for good; true if the device received that.
  bool finish() noexcept;

  bool lost() const noexcept { return lost_.load(std::memory_order_relaxed); }
  // Reports that were damaged or made no sense.
  std::uint64_t unusable() const noexcept { return unusable_.load(std::memory_order_relaxed); }

 private:
  using Torque = std::array<double, kMaxDof>;
  struct Command {
    Torque torque{};
    nanoseconds moment{};
    std::uint32_t lapses = 0;  // that the loop knew of
    bool any = false;          // any was given yet
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

  std::uint32_t known_lapses_ = 0;  // to the haptic thread
  TripleBuffer<Command> commands_;
  TripleBuffer<Arrival> arrivals_;
  std::atomic<bool> lost_{false};
  std::atomic<std::uint64_t> unusable_{0};

  // Of the I/O thread.
  std::array<std::uint8_t, HidTransport::kMaxMessage> buffer_{};
  Arrival arrival_;
  SendReport deliver_, deliver_if_due_;
  bool news_ = false;       // a command has come since the last torque was sent
  bool overtaken_ = false;  // what is being sent is not to be sent any more
  nanoseconds sent_{};
  nanoseconds heard_{};    // by the device
  nanoseconds went_on_{};  // in send(): from report to report, up to a stall
  bool sent_any_ = false;
  int failures_ = 0;
  nanoseconds asked_{};
};

}  // namespace limpid
